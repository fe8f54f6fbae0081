// An unblended mosaic of a project's pictures before and after correction, to judge a fit by eye.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/fitting.hpp"
#include "cli/fitting/project.hpp"

namespace lensprof {

// Failure (usage) for a name without a picture extension.
void check_preview(const std::string &path);

// Writes the mosaic before and, below it, after correction, of the images with an exposure in the result: each point is
// taken from the picture whose centre is nearest. Rectilinear if all cameras look forward or the camera moved, else
// equirectangular.
void write_preview(const std::string &path, const Project &project, const Fitted &fitted, Progress &progress);

}  // namespace lensprof
