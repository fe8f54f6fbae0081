// What the verdict on a fit measures: one number for each rule.
#pragma once

#include "fit/verdict/evenness.hpp"
#include "fit/verdict/finish.hpp"
#include "fit/verdict/known_exposures.hpp"
#include "fit/verdict/rule.hpp"

namespace lensprof {

// What is true of a fit: a rule states what it needs.
enum State : uint32_t {
    kAlways = 0,
    kStatic = 1,  // equal places are compared
    kMoving = 2,  // they are not
    kStill = 4,   // equal places, and the response is free: no falloff can be biased
    kNotStill = 8,
    kFreesResponse = 16,
    kFreesFalloff = 32,
    kFreesCenter = 64,
    kFreesAll = 128,        // response and falloff: nothing that is held can be what does not fit
    kHolds = 256,           // one of them is held
    kLeavesOutKnown = 512,  // known exposures that contradict the pictures and the others
    kMovingCamera = 1024,   // it did not only turn
    kHasSeams = 2048        // the last step, for results that may be used: the seams have been measured
};

// A finished fit of one lens setting under judgement.
struct Judged {
    const Found &found;
    const FitResult &r;
    KnownExposures known;
    Seam seam{};  // once the state has kHasSeams
    uint32_t state;
    Wording wording;  // of most rules

    Judged(const Found &finished, const FitResult &result);
    const Problem &problem() const { return found.problem; }
    const Estimate &estimate() const { return found.estimate; }
};

using FitRule = VerdictRule<Judged>;

namespace measure {

Measured groups(const Judged &judged);
Measured pairs_per_unknown(const Judged &judged);
Measured exposure_spread(const Judged &judged);
Measured covered_greys(const Judged &judged);
Measured missing_greys(const Judged &judged);
Measured radius_change(const Judged &judged);
Measured covered_radius(const Judged &judged);

Measured agreement(const Judged &judged);
Measured still_agreement(const Judged &judged);
Measured noise(const Judged &judged);
Measured strong_pattern(const Judged &judged);
Measured weak_pattern(const Judged &judged);
Measured pattern_oddness(const Judged &judged);
Measured frame_pattern(const Judged &judged);
Measured joined_images(const Judged &judged);
Measured image_inliers(const Judged &judged);
Measured image_agreement(const Judged &judged);
Measured image_residual(const Judged &judged);
Measured outliers(const Judged &judged);
Measured heldout_rms(const Judged &judged);
Measured seam(const Judged &judged);

Measured convergence(const Judged &judged);
Measured covariance(const Judged &judged);
Measured corner_sigma(const Judged &judged);
Measured center_on_axis(const Judged &judged);
Measured center_distance(const Judged &judged);
Measured clear_rise(const Judged &judged);
Measured darkest(const Judged &judged);

Measured exposure_sigma(const Judged &judged);
Measured held_white_balance(const Judged &judged);
Measured known_order(const Judged &judged);
Measured known_single(const Judged &judged);
Measured known_outlier(const Judged &judged);
Measured known_step_up(const Judged &judged);
Measured known_step_down(const Judged &judged);
Measured known_any(const Judged &judged);
Measured gamma_inconsistency(const Judged &judged);
Measured response_oddness(const Judged &judged);

}  // namespace measure

}  // namespace lensprof
