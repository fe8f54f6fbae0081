// Responses that the pictures do not determine.
#pragma once

#include <functional>

#include <lensprof/fit.h>

#include "fit/verdict/result.hpp"

namespace lensprof {

// A fit of the same data with other options.
using FitHeld =
    std::function<void(const lensprof_fit_options &options, lensprof_exposure *exposures, FitResult &result)>;

// States that a result has the typical response of its kind of camera, whose ln gamma has this standard error, which
// the exposures share.
void state_typical(double gamma_sigma, uint32_t image_count, const lensprof_exposure *exposures, FitResult &result);

// If the light at the ends of the pairs differs too little to determine a response, replaces the result by one with a
// held response, including its errors: that of the prior profile, or else, by another fit, the typical response of the
// kind of camera. The paper's own variant, without a prior, is unchanged.
void resolve_unobserved_response(const lensprof_fit_options &options, uint32_t image_count, const FitHeld &fit,
                                 lensprof_exposure *exposures, FitResult &result);

}  // namespace lensprof
