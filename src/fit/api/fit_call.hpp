// The arguments and results of a call of the overlap fit, converted between the caller's struct versions and this
// library's.
#pragma once

#include <vector>

#include <lensprof/fit.h>

#include "fit/verdict/result.hpp"

#include "fit/base/sized.hpp"

namespace lensprof {

// Sizes of the structs in the first version of the library.
constexpr size_t kFirstOptions = LP_END_OF(lensprof_fit_options, unlinked_images);
constexpr size_t kFirstImage = LP_END_OF(lensprof_fit_image, crop_factor);

// All arguments and results of a call except pairs, observations and exposures, in this library's struct versions.
struct FitCall {
    lensprof_fit_options options;
    lensprof_response linear;
    std::vector<lensprof_fit_image> images;
    FitResult result = empty_result();
    std::vector<lensprof_fit_image_quality> quality;
    std::vector<SettingResult> settings;  // empty if all images have setting 0
    std::vector<CameraResult> cameras;    // empty if all images have camera 0

    uint32_t count() const { return static_cast<uint32_t>(images.size()); }
    int channels() const { return static_cast<int>(options.channels); }
};

lensprof_status take_images(const lensprof_fit_image *given, uint32_t count, std::vector<lensprof_fit_image> &images,
                            lensprof_error *error);

// Checks common to both fits: everything except the pairs or observations.
lensprof_status take_call(const lensprof_fit_options *options, const lensprof_fit_image *images, uint32_t image_count,
                          bool has_data, const lensprof_exposure *exposures, FitCall &call, lensprof_error *error);

}  // namespace lensprof
