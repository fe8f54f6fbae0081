// The calibration of a scene: what it was made from, its fit, and what is made of that.
#pragma once

#include <string>
#include <vector>

#include "photo/calibration/scene_fit.hpp"

namespace lensprof {

// The fit refers to the events, which must live as long.
struct Calibration {
    // Fits. Failure.
    Calibration(Scene of, const SceneFitOptions &o, Events &events);

    SceneFitOptions options;
    Scene scene;
    std::vector<PictureMetadata> metadata;
    lensprof_profile_key key{};  // of the reference
    EarlierProfile prior;
    SceneFit fit;
};

// The scene with the exposures, responses and falloffs of the result.
Scene with_result(const Calibration &calibration);

}  // namespace lensprof
