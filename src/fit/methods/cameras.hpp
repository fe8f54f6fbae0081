// Several cameras in one fit: each on its own pictures, then joined by what they share.
#pragma once

#include <functional>
#include <vector>

#include <lensprof/fit.h>

namespace lensprof {

// The images of one camera, and the data between them.
struct CameraInput {
    lensprof_fit_options options;   // its reference and links are of these images
    std::vector<uint32_t> numbers;  // of its images among all
    std::vector<lensprof_fit_image> images;
    std::vector<lensprof_link> links;
    std::vector<lensprof_pair> pairs;
    std::vector<lensprof_observation> observations;
};

// Fits one camera's images; false where the data between them do not serve. `result` has room for image_quality and
// settings.
using FitCamera =
    std::function<bool(const CameraInput &input, lensprof_exposure *exposures, lensprof_fit_result &result)>;

// Whether images are of several cameras that a fit has to tell apart: where the response is held, all share it.
bool has_several_cameras(const lensprof_fit_options &options, const std::vector<lensprof_fit_image> &images);

// Fits all. `pairs`: of all data; `observations`: the tracks that are fitted in their place, or none. The result has
// settings, and `cameras` for every camera of the images. False where no camera has a fit.
bool fit_cameras(const lensprof_fit_options &options, const std::vector<lensprof_fit_image> &images,
                 const std::vector<lensprof_pair> &pairs, const std::vector<lensprof_observation> &observations,
                 const FitCamera &fit, lensprof_exposure *exposures, lensprof_fit_result &result);

}  // namespace lensprof
