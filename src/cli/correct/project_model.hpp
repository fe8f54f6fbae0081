// What a project with a result in it says about its pictures.
#pragma once

#include <memory>
#include <vector>

#include "cli/fitting/project.hpp"

namespace lensprof {

// Response and falloff of an image.
std::shared_ptr<const lensprof_profile> model_of_project(const Project &project, uint32_t image);

// That of the reference, where images have several: what all are encoded by, so that they look alike. NULL where they
// have one.
std::shared_ptr<const lensprof_response> common_encoding(const Project &project);

// The project's exposures, relative to its reference, or where the result is without that to the first image that it
// has.
std::vector<lensprof_exposure> relative_to_joined(const Project &project);

// Those of images that the result in the project is not without.
std::vector<lensprof_exposure> joined_exposures(const Project &project, const std::vector<lensprof_exposure> &all);

}  // namespace lensprof
