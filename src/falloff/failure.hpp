// What is thrown where no falloff can be made of what is given.
#pragma once

#include <string>

#include <lensprof/base.h>

namespace lensprof {

// The text is complete: "what is wrong; next step".
struct FalloffFailure {
    lensprof_status status;
    std::string text;
    lensprof_item item{};  // that the text begins with
};

}  // namespace lensprof
