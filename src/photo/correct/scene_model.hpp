// The models of a scene with a result.
#pragma once

#include <memory>
#include <vector>

#include "photo/scene/scene.hpp"

namespace lensprof {

// The response of the reference if the images have several: all outputs are encoded with it so that they look alike.
// NULL if the images share one response.
std::shared_ptr<const lensprof_response> common_encoding(const Scene &scene);

// The exposures of the scene, relative to its reference or, if the result does not include it, to the first included
// image.
std::vector<lensprof_exposure> relative_to_joined(const Scene &scene);

// The exposures of the images included in the result.
std::vector<lensprof_exposure> joined_exposures(const Scene &scene, const std::vector<lensprof_exposure> &all);

}  // namespace lensprof
