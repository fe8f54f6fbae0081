// Which files an output of `lensprof calibrate` of a clip must not replace.
#pragma once

#include <string>
#include <vector>

#include "cli/calibrate/clip.hpp"

namespace lensprof {

// Failure (usage) before anything is measured: for an output that is one of the files `inputs`, the database or another
// output, and for a file in the output folder that no earlier run wrote, without `o.overwrite`.
void check_conflicts(const ClipCommand &o, const std::vector<std::string> &inputs);

}  // namespace lensprof
