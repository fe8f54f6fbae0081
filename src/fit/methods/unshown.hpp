// Responses that pictures do not show.
#pragma once

#include <functional>

#include <lensprof/fit.h>

namespace lensprof {

// A fit of the same data with other options.
using FitHeld =
    std::function<void(const lensprof_fit_options &options, lensprof_exposure *exposures, lensprof_fit_result &result)>;

// Where the light at the ends of the pairs differs too little for what was fitted to be a response, the result becomes
// one with the response held: at that of the profile that is the prior, or by another fit at the typical one of the
// kind of camera, with the errors of that. The paper's own variant, without a prior, stays as it is.
void settle_unshown_response(const lensprof_fit_options &options, uint32_t image_count, const FitHeld &fit,
                             lensprof_exposure *exposures, lensprof_fit_result &result);

}  // namespace lensprof
