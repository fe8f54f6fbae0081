// Falloffs of fits and profiles, for tables and charts.
#pragma once

#include <algorithm>
#include <memory>

#include <lensprof/profile.h>

#include "cli/program/library.hpp"

namespace lensprof {

// False where all is light as the centre is: a falloff held at none, or not measured, as by `bracket`.
inline bool has_falloff(const lensprof_vignetting &v) { return v.k[0] != 0.0 || v.k[1] != 0.0 || v.k[2] != 0.0; }

// The curves and the covariance of a fit (lensprof_fit_result, lensprof_flat_result) with these responses, 1 or 3.
template <class Fit>
std::unique_ptr<lensprof_profile> profile_of_curves(const Fit &fit, const lensprof_response *response,
                                                    uint32_t responses) {
    auto profile = new_profile();
    profile->responses = responses;
    std::copy_n(response, responses, profile->response);
    profile->vignettings = fit.vignettings;
    std::copy_n(fit.vignetting, 3, profile->vignetting);
    profile->covariance_size = fit.covariance_size;
    std::copy_n(fit.covariance, fit.covariance_size * fit.covariance_size, profile->covariance);
    return profile;
}

}  // namespace lensprof
