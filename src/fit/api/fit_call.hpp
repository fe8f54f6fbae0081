// The arguments and results of a call of the overlap fit, converted between the caller's struct versions and this
// library's.
#pragma once

#include <vector>

#include "fit/base/sized.hpp"
#include "fit/methods/fit_call.hpp"

namespace lensprof {

// Sizes of the structs in the first version of the library.
constexpr size_t kFirstOptions = LP_END_OF(lensprof_fit_options, unlinked_images);
constexpr size_t kFirstImage = LP_END_OF(lensprof_fit_image, crop_factor);

lensprof_status take_images(const lensprof_fit_image *given, uint32_t count, std::vector<lensprof_fit_image> &images,
                            lensprof_error *error);

// Checks common to both fits: everything except the pairs or observations.
lensprof_status take_call(const lensprof_fit_options *options, const lensprof_fit_image *images, uint32_t image_count,
                          bool has_data, const lensprof_exposure *exposures, FitCall &call, lensprof_error *error);

}  // namespace lensprof
