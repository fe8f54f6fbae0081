// A pair whose ends received the same light, t = 1 in B1 - f( g(B2) t ), obeys every response. If t is 1 for all pairs
// except for noise, a fit finds the response that best explains rounding and interpolation, and its errors are not
// valid. The response is therefore held at what cameras of the kind have in common, with their differences as the
// covariance.
#include "fit/methods/unconstrained.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/covariance.h"
#include "core/profile.h"
#include "fit/base/constants.hpp"
#include "fit/verdict/judge.hpp"
#include "fit/verdict/limits.hpp"

namespace lensprof {
namespace {

// The covariance of the response is the kind's; gamma, which is in it, moves the falloff as well.
template <class Part>  // the result, or one of its settings
void state_errors(const double *covariance, const FitResult &r, Part &part) {
    const uint32_t n = r.covariance_size, modes = LENSPROF_EMOR_MODES;
    const double gamma_sigma = r.gamma_sigma;
    for (uint32_t i = 0; i < modes && n; i++) std::copy_n(covariance + i * modes, modes, part.covariance + i * n);
    std::fill_n(part.gamma_direction, LENSPROF_COVARIANCE_MAX, 0.0);
    for (uint32_t curve = 0; curve < r.vignettings && n; curve++)
        for (int k = 0; k < 3; k++)
            part.gamma_direction[lp_covariance_index(modes, curve) + static_cast<uint32_t>(k)] =
                part.vignetting[curve].k[k];  // of M^gamma, where M is near 1
    for (uint32_t i = modes; i < n; i++)
        for (uint32_t j = modes; j < n; j++)
            part.covariance[i * n + j] +=
                gamma_sigma * gamma_sigma * (part.gamma_direction[i] * part.gamma_direction[j]);
}

// Whether the profile contains information about the response, and the pictures do not contradict it.
bool holds_response(const lensprof_profile &profile, const FitResult &r) {
    const bool is_kept =
        r.profile_prior == LENSPROF_PROFILE_PRIOR_USED || r.profile_prior == LENSPROF_PROFILE_PRIOR_FALLOFF_OVERRULED;
    return is_kept && !lp_provenance_doubts_response(&profile.provenance)
           && (lp_covariance_modes(profile.response, profile.responses) > 0 || profile.provenance.gamma_sigma > 0.0);
}

// With the differences between cameras of the kind as the error.
void hold_typical(const lensprof_fit_options &options, uint32_t image_count, const FitHeld &fit,
                  lensprof_exposure *exposures, FitResult &r) {
    lensprof_response typical;
    std::vector<double> covariance(LENSPROF_EMOR_MODES * LENSPROF_EMOR_MODES);
    double sigma;
    if (lensprof_response_set_typical(&typical, options.camera_kind, covariance.data(), &sigma) != LENSPROF_OK)
        throw std::invalid_argument("unknown kind of camera");
    lensprof_fit_options held = options;
    held.free &= ~LENSPROF_FREE_RESPONSE;
    held.response = &typical;
    held.profile = nullptr;
    fit(held, exposures, r);
    state_typical(sigma, image_count, exposures, r);
    for_each_verdict(r, [&](auto &part) { state_errors(covariance.data(), r, part); });
}

}  // namespace

void state_typical(double gamma_sigma, uint32_t image_count, const lensprof_exposure *exposures, FitResult &r) {
    r.response_from = LENSPROF_FIT_RESPONSE_KIND;
    r.gamma_from = LENSPROF_GAMMA_PRIOR;
    r.gamma_sigma = gamma_sigma;
    for (uint32_t i = 0; i < image_count && r.image_quality; i++) {
        double &sigma = r.image_quality[i].ev_sigma;
        if (sigma > 0.0) sigma = std::hypot(sigma, gamma_sigma * (exposures[i].ev - exposures[r.reference].ev));
    }
}

void resolve_unobserved_response(const lensprof_fit_options &options, uint32_t image_count, const FitHeld &fit,
                                 lensprof_exposure *exposures, FitResult &r) {
    const bool is_narrow = first_code(r.verdict) == LENSPROF_REASON_FEW_GREYS;
    const bool is_even =
        r.irradiance_spread_ev < kSmallestLightSpread && first_code(r.verdict) != LENSPROF_REASON_EXPOSURES_EQUAL;
    if (r.response_from != LENSPROF_FIT_RESPONSE_PICTURES || !(options.prior_weight > 0.0)) return;
    if (is_narrow ? r.verdict[0].value[0] < kFewestGreys || !(options.free & LENSPROF_FREE_FALLOFF) : !is_even) return;
    const double spread_ev = r.irradiance_spread_ev;
    if (options.profile && holds_response(*options.profile, r))
        r.response_from = LENSPROF_FIT_RESPONSE_PROFILE;
    else
        hold_typical(options, image_count, fit, exposures, r);
    for_each_verdict(r, [&](auto &verdict) {
        report_last(verdict,
                    found_by_method(LENSPROF_REASON_RESPONSE_UNCONSTRAINED,
                                    of_values(is_narrow ? NAN : spread_ev, r.irradiance_spread_ev, r.gamma_sigma)));
    });
}

}  // namespace lensprof
