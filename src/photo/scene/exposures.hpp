// Exposures of a scene, relative to one another.
#pragma once

#include <vector>

#include "photo/scene/scene.hpp"

namespace lensprof {

// Exposures and white balances relative to those of one image.
std::vector<lensprof_exposure> relative_exposures(std::vector<lensprof_exposure> exposures, uint32_t reference);

// Geometric mean of exposures and white balances (Goldman & Chen 2005, equation 15) of the images not left out.
lensprof_exposure mean_exposure(const std::vector<lensprof_exposure> &exposures);

// The exposures of the project, relative to its reference.
std::vector<lensprof_exposure> scene_exposures(const Scene &scene);

}  // namespace lensprof
