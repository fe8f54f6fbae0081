// The fit of frames of a stationary camera.
#pragma once

#include <vector>

#include "photo/calibration/fit.hpp"
#include "photo/scene/scene.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {

// Fits response, exposures and white balances of a scene of static_scene(), relative to its reference. EXIF exposures
// are soft observations. `pictures` receives the reduced pictures, unless it is NULL.
Fitted fit_still(const Scene &scene, const FitOptions &options, const SamplingOptions &pixels, Events &events,
                 std::vector<SamplePicture> *pictures = nullptr);

}  // namespace lensprof
