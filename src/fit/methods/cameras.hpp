// Several cameras in one fit: each on its own pictures, then joined by what they share.
#pragma once

#include <functional>

#include "fit/methods/camera_input.hpp"

namespace lensprof {

// Fits one camera's images; false where the data between them do not serve. `result` has room for image_quality and
// settings.
using FitCamera =
    std::function<bool(const CameraInput &input, lensprof_exposure *exposures, lensprof_fit_result &result)>;

// Whether images are of several cameras that a fit has to tell apart: where the response is held, all share it.
bool has_several_cameras(const lensprof_fit_options &options, const std::vector<lensprof_fit_image> &images);

// Fits all. The result has settings, and `cameras` for every camera of the images. False where no camera has a fit.
bool fit_cameras(const CamerasData &data, const FitCamera &fit, lensprof_exposure *exposures,
                 lensprof_fit_result &result);

}  // namespace lensprof
