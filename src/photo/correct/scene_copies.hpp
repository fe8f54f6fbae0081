// Copies of the pictures of a calibrated scene.
#pragma once

#include <string>
#include <vector>

#include <lensprof/photo.h>

#include "photo/correct/correction.hpp"
#include "photo/scene/project.hpp"

namespace lensprof {

struct CopyNames {
    std::string source, target;
};

// Without a model: at its own exposure.
Correction copy_of_picture(const CopyNames &names);

// The mean exposure, lowered so that no picture is lifted by more than 1 EV: what is brighter than half the limit
// clips.
lensprof_exposure common_exposure(const std::vector<lensprof_exposure> &exposures);

// With the models and exposures of a scene with a result. `exposure`: lensprof_copy_exposure. Failure (NOT_FOUND) for a
// picture that is not in the result.
std::vector<Correction> copies_of_scene(const Project &scene, const std::vector<CopyNames> &names, uint32_t exposure);

}  // namespace lensprof
