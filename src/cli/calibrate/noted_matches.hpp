// Matches between pictures as the ledger keeps them.
#pragma once

#include <vector>

#include <lensprof/lensprof.h>

#include "cli/report/report.hpp"

namespace lensprof {

struct NotedMatches {
    std::vector<lensprof_match> list;
    bool are_all = false;  // these, and not the cameras, say where pictures show the same
};

Json json_of(const NotedMatches &matches);

// What json_of wrote, of so many images; false where it is something else.
bool read_noted(const Json &json, size_t images, NotedMatches &matches);

}  // namespace lensprof
