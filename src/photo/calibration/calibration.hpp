// The calibration of a scene: what it was made from, its fit, and what is made of that.
#pragma once

#include <string>
#include <vector>

#include "photo/calibration/project_fit.hpp"

namespace lensprof {

// The fit refers to the events, which must live as long.
struct Calibration {
    // Fits. Failure.
    Calibration(Project of, const ProjectFitOptions &o, Events &events);

    ProjectFitOptions options;
    Project project;
    std::vector<PictureMetadata> metadata;
    lensprof_profile_key key{};  // of the reference
    EarlierProfile prior;
    ProjectFit fit;
};

// The scene with the exposures, responses and falloffs of the result.
Project with_result(const Calibration &calibration);

}  // namespace lensprof
