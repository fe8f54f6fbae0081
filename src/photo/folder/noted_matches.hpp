// Matches between pictures as stored in the ledger.
#pragma once

#include <vector>

#include <lensprof/lensprof.h>

#include "photo/report/report.hpp"

namespace lensprof {

struct NotedMatches {
    std::vector<lensprof_match> list;
    bool are_all = false;  // pictures are compared at these matches instead of through the cameras
};

Json json_of(const NotedMatches &matches);

// Parses the output of json_of for this number of images; false if the JSON is something else.
bool read_noted(const Json &json, size_t images, NotedMatches &matches);

}  // namespace lensprof
