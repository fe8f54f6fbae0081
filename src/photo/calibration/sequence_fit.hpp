// The fit of the frames of a sequence.
#pragma once

#include <vector>

#include "photo/calibration/fit.hpp"
#include "photo/scene/scene.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {

// Fits exposures and white balances, relative to the reference, and what else the first image of the scene has free: of
// a static_scene() the response, of a project the lens, too. EXIF exposures are soft observations. `pictures` receives
// the reduced pictures, unless it is NULL.
Fitted fit_sequence(const Scene &scene, const FitOptions &options, const SamplingOptions &pixels, Events &events,
                    std::vector<SamplePicture> *pictures = nullptr);

}  // namespace lensprof
