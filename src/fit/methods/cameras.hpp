// Several cameras in one fit: each is fitted to its own pictures, then they are joined by the data they share.
#pragma once

#include <functional>

#include "fit/methods/camera_input.hpp"
#include "fit/verdict/result.hpp"

namespace lensprof {

// Fits the images of one camera; false if the data between them are insufficient. `result` has room for image_quality
// and settings.
using FitCamera = std::function<bool(const CameraInput &input, lensprof_exposure *exposures, FitResult &result)>;

// Whether the images are of several cameras that a fit must distinguish. If the response is held, all share it.
bool has_several_cameras(const lensprof_fit_options &options, const std::vector<lensprof_fit_image> &images);

// Fits all cameras. The result has settings, and `cameras` for every camera of the images. False if no camera could be
// fitted.
bool fit_cameras(const CamerasData &data, const FitCamera &fit, lensprof_exposure *exposures, FitResult &result);

}  // namespace lensprof
