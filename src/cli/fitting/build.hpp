// `lensprof build`, for other commands.
#pragma once

#include <string>
#include <vector>

#include "cli/program/run.hpp"

namespace lensprof {

// Fits pictures, a project or a reconstruction (with its pictures in the folder `images`, unless that is empty) and
// writes the report `page`; nothing is stored. Returns the exit code.
int build_page(const std::vector<std::string> &inputs, const std::string &images, const std::string &page,
               Streams &streams);

}  // namespace lensprof
