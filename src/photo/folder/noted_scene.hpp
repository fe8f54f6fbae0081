// What registration has found of a group of pictures, as stored in the ledger.
#pragma once

#include "photo/registration/registration.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

// Cameras, control points and matches. Places are rounded to 0.01 px or less.
Json json_of(const FoundScene &found);

// Parses the output of json_of for this number of pictures; false if the JSON is something else.
bool read_noted(const Json &json, size_t pictures, FoundScene &found);

}  // namespace lensprof
