// Response and exposures from the brightness transfer functions of image pairs (Kim & Pollefeys 2004), alternating with
// the falloff: from checked input to result.
#pragma once

#include <lensprof/fit.h>

#include "fit/verdict/result.hpp"

namespace lensprof {

void fit_transfer_functions(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                            const lensprof_pair *pairs, uint32_t pair_count, lensprof_exposure *exposures,
                            FitResult &result);

}  // namespace lensprof
