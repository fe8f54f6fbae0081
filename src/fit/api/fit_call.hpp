// The arguments and results of a call of the overlap fit, converted between the caller's struct versions and this
// library's.
#pragma once

#include <vector>

#include <lensprof/fit.h>

#include "fit/base/sized.hpp"

namespace lensprof {

// Sizes of the structs in the first version of the library.
constexpr size_t kFirstOptions = LP_END_OF(lensprof_fit_options, progress_user);
constexpr size_t kFirstImage = LP_END_OF(lensprof_fit_image, known_ev_sigma);
constexpr size_t kFirstResult = LP_END_OF(lensprof_fit_result, image_quality);
constexpr size_t kFirstSetting = sizeof(lensprof_fit_setting);
constexpr size_t kFirstCamera = sizeof(lensprof_fit_camera);
constexpr size_t kFirstQuality = LP_END_OF(lensprof_fit_image_quality, known_ev_left_out);

// All arguments and results of a call except pairs, observations and exposures, in this library's struct versions.
struct FitCall {
    lensprof_fit_options options;
    lensprof_response linear;
    std::vector<lensprof_fit_image> images;
    lensprof_fit_result result;
    std::vector<lensprof_fit_image_quality> quality;
    std::vector<lensprof_fit_setting> settings;      // empty if all images have setting 0
    std::vector<lensprof_fit_camera> cameras;        // empty if all images have camera 0
    lensprof_fit_setting *given_settings = nullptr;  // the caller's arrays, or NULL
    lensprof_fit_camera *given_cameras = nullptr;
    uint32_t given_setting_count = 0, given_camera_count = 0;

    uint32_t count() const { return static_cast<uint32_t>(images.size()); }
    int channels() const { return static_cast<int>(options.channels); }
};

lensprof_status take_images(const lensprof_fit_image *given, uint32_t count, std::vector<lensprof_fit_image> &images,
                            lensprof_error *error);

// Checks common to both fits: everything except the pairs or observations.
lensprof_status take_call(const lensprof_fit_options *options, const lensprof_fit_image *images, uint32_t image_count,
                          bool has_data, const lensprof_exposure *exposures, const lensprof_fit_result *result,
                          FitCall &call, lensprof_error *error);

// Copies the settings into the caller's arrays, which may have fewer elements than this library's. Their addresses and
// sizes in the result stay.
void give_settings(FitCall &call);

}  // namespace lensprof
