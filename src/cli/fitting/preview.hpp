// An unblended mosaic of a project's pictures before and after correction: what a fit is worth, at a glance.
#pragma once

#include <string>

#include "cli/fitting/fitting.hpp"
#include "cli/fitting/project.hpp"

namespace lensprof {

// Failure (usage) for a name that no picture can have.
void check_preview(const std::string &path);

// Writes the mosaic before, and below it the mosaic after, both of the images that the result has exposures of: each
// place by the picture whose middle is nearest. Rectilinear where all looks ahead or the camera moved, else
// equirectangular.
void write_preview(const std::string &path, const Project &project, const Fitted &fitted, Progress &progress);

}  // namespace lensprof
