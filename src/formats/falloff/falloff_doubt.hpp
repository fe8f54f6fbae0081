// What is suspicious about a falloff of somebody else's database.
#pragma once

#include <string>

#include <lensprof/model.h>

namespace lensprof {

struct FalloffDoubt {
    bool usable;       // lensprof_vignetting_validate accepts it
    std::string text;  // below 64 bytes, empty when there is no doubt
};

FalloffDoubt find_doubt(const lensprof_vignetting &vignetting);

}  // namespace lensprof
