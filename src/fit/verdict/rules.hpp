// The verdict on fits: all rules, the most important first within a severity. `limits.hpp` states where a limit
// comes from. Table one: what a finished fit is measured for. Table two: what a method finds on the way to it.
#pragma once

#include "falloff/rise.hpp"
#include "fit/problem/curve_shape.hpp"
#include "fit/verdict/limits.hpp"
#include "fit/verdict/measures.hpp"

namespace lensprof {

// clang-format off
constexpr FitRule kRules[] = {
    // Pairs are too few, too similar, or at places that carry no information.
    {LENSPROF_REASON_IMAGE_GROUPS,        kRefuses, kStatic,                measure::groups,              Side::above, 1.0,                     Wording::usual},
    {LENSPROF_REASON_FEW_PAIRS,           kRefuses, kAlways,                measure::pairs_per_unknown,   Side::below, kPairsPerUnknown,        Wording::usual},
    {LENSPROF_REASON_EXPOSURES_EQUAL,     kRefuses, kStatic|kFreesResponse, measure::exposure_spread,     Side::below, kSmallestSpread,         Wording::usual},
    {LENSPROF_REASON_FEW_GREYS,           kRefuses, kFreesResponse,         measure::covered_greys,       Side::below, kMinGreys,               Wording::usual},
    {LENSPROF_REASON_SAME_VIEW,           kRefuses, kMoving|kFreesFalloff,  measure::radius_change,       Side::below, kSameView,               Wording::usual},
    {LENSPROF_REASON_SMALL_RADIUS,        kRefuses, kFreesFalloff,          measure::covered_radius,      Side::below, kSmallestRadius,         Wording::usual},
    // They contradict every camera.
    {LENSPROF_REASON_FEW_AGREE,           kRefuses, kStill,                 measure::still_agreement,     Side::below, kSmallestStillAgreement, Wording::still},
    {LENSPROF_REASON_FEW_AGREE,           kRefuses, kAlways,                measure::agreement,           Side::below, kSmallestAgreement,      Wording::usual},
    {LENSPROF_REASON_PATTERNS,            kRefuses, kStill,                 measure::strong_pattern,      Side::above, kHarmfulStillPattern,    Wording::still},
    {LENSPROF_REASON_PATTERNS,            kRefuses, kNotStill|kFreesAll,    measure::strong_pattern,      Side::above, kHarmfulPattern,         Wording::usual},
    {LENSPROF_REASON_PATTERNS,            kRefuses, kNotStill|kHolds,       measure::strong_pattern,      Side::above, kSmallestPattern,        Wording::held},
    {LENSPROF_REASON_SCATTER,             kRefuses, kAlways,                measure::noise,               Side::above, kLargestNoise,           Wording::usual},
    // They do not determine the result.
    {LENSPROF_REASON_NOT_CONVERGED,       kRefuses, kAlways,                measure::convergence,         Side::below, 1.0,                     Wording::usual},
    {LENSPROF_REASON_UNDETERMINED,        kRefuses, kAlways,                measure::covariance,          Side::below, 1.0,                     Wording::usual},
    {LENSPROF_REASON_CORNER_UNCERTAIN,    kRefuses, kAlways,                measure::corner_sigma,        Side::above, kLargestCornerSigma,     Wording::usual},
    {LENSPROF_REASON_CENTER_ON_LIMIT,     kRefuses, kFreesCenter,           measure::center_on_axis,      Side::above, kOnLimit*kLargestCenter, Wording::usual},
    {LENSPROF_REASON_FALLOFF_RISES,       kRefuses, kAlways,                measure::clear_rise,          Side::above, kLargestRise,            Wording::usual},
    {LENSPROF_REASON_FALLOFF_DARK,        kRefuses, kFreesFalloff,          measure::darkest,             Side::below, kSmallestM,              Wording::usual},
    {LENSPROF_REASON_FEW_INLIERS,         kRefuses, kAlways,                measure::image_inliers,       Side::below, kMinInliers,             Wording::usual},
    {LENSPROF_REASON_IMAGE_DISAGREES,     kRefuses, kAlways,                measure::image_agreement,     Side::below, kSmallestImageShare,     Wording::usual},
    {LENSPROF_REASON_EXPOSURE_UNCERTAIN,  kRefuses, kAlways,                measure::exposure_sigma,      Side::above, kLargestEvSigma,         Wording::usual},
    {LENSPROF_REASON_PATTERNS,            kRefuses, kNotStill|kFreesResponse, measure::pattern_oddness, Side::above, kUnusual,                Wording::odd},
    // The pictures still show it, or a number that people use is wrong.
    {LENSPROF_REASON_WHITE_BALANCE_FIXED, kWarns,   kAlways,                measure::held_white_balance,  Side::above, 0.0,                     Wording::usual},
    {LENSPROF_REASON_IMAGE_INCONSISTENT,  kWarns,   kAlways,                measure::image_residual,      Side::above, kInconsistentImage,      Wording::usual},
    {LENSPROF_REASON_KNOWN_ORDER,         kWarns,   kAlways,                measure::known_order,         Side::above, 0.0,                     Wording::usual},
    {LENSPROF_REASON_KNOWN_STEP,          kWarns,   kAlways,                measure::known_step_up,       Side::above, 0.0,                     Wording::usual},
    {LENSPROF_REASON_KNOWN_STEP,          kWarns,   kAlways,                measure::known_step_down,     Side::above, 0.0,                     Wording::less},
    {LENSPROF_REASON_KNOWN_CONTRADICT,    kWarns,   kAlways,                measure::known_any,           Side::above, kWrongByAStop,           Wording::usual},
    {LENSPROF_REASON_GAMMA_INCONSISTENT,  kWarns,   kAlways,                measure::gamma_inconsistency, Side::above, kInconsistentGamma,      Wording::usual},
    {LENSPROF_REASON_PATTERNS,            kWarns,   kStill,                 measure::weak_pattern,        Side::above, kStillPattern,           Wording::weak},
    {LENSPROF_REASON_PATTERNS,            kWarns,   kNotStill,              measure::weak_pattern,        Side::above, kWeakPattern,            Wording::weak},
    {LENSPROF_REASON_UNUSUAL_RESPONSE,    kWarns,   kAlways,                measure::response_oddness,    Side::above, kVeryUnusual,            Wording::usual},
    {LENSPROF_REASON_SEAMS_REMAIN,        kWarns,   kHasSeams,              measure::seam,                Side::above, kSeen,                   Wording::usual},
    // Worth knowing.
    {LENSPROF_REASON_KNOWN_WRONG,         kNotes,   kAlways,                measure::known_single,        Side::above, 0.0,                     Wording::usual},
    {LENSPROF_REASON_KNOWN_WRONG,         kNotes,   kLeavesOutKnown,        measure::known_outlier,       Side::above, 0.0,                     Wording::usual},
    {LENSPROF_REASON_KNOWN_WRONG,         kNotes,   kAlways,                measure::known_outlier,       Side::above, kContradiction,          Wording::usual},
    {LENSPROF_REASON_KNOWN_CONTRADICT,    kNotes,   kAlways,                measure::known_any,           Side::above, 0.0,                     Wording::usual},
    {LENSPROF_REASON_NOT_RADIAL,          kNotes,   kAlways,                measure::frame_pattern,       Side::above, kSmallestPattern,        Wording::usual},
    {LENSPROF_REASON_FALLOFF_RISES,       kNotes,   kAlways,                measure::clear_rise,          Side::above, 1.0+kSmallRise,          Wording::weak},
    {LENSPROF_REASON_FEW_IMAGES,          kNotes,   kMoving|kMovingCamera|kFreesFalloff, measure::joined_images, Side::below, kMovingImages,           Wording::usual},
    {LENSPROF_REASON_FAR_CENTER,          kNotes,   kFreesCenter,           measure::center_distance,     Side::above, kFarCenter,              Wording::usual},
    {LENSPROF_REASON_MISSING_GREYS,       kNotes,   kFreesResponse,         measure::missing_greys,       Side::below, kEnoughGreys,            Wording::usual},
    {LENSPROF_REASON_UNUSUAL_RESPONSE,    kNotes,   kAlways,                measure::response_oddness,    Side::above, kUnusual,                Wording::usual},
    {LENSPROF_REASON_MANY_OUTLIERS,       kNotes,   kHasSeams,              measure::outliers,            Side::above, 1.0-kSmallestShare,      Wording::usual},
    {LENSPROF_REASON_MANY_OUTLIERS,       kNotes,   kHasSeams,              measure::heldout_rms,         Side::above, kLargestRms,             Wording::usual},
    {LENSPROF_REASON_SEAMS_REMAIN,        kNotes,   kHasSeams,              measure::seam,                Side::above, 0.0,                     Wording::usual},
};
constexpr size_t kRuleCount = sizeof kRules / sizeof *kRules;

// The methods decide what is found, as part of choosing images, models and priors. A limit, if one number decides.
constexpr MethodRule kMethodRules[] = {
    // methods/group.cpp, cameras.cpp: which images take part
    {LENSPROF_REASON_IMAGE_GROUPS,             kRefuses, NAN},
    {LENSPROF_REASON_IMAGES_MINORITY,          kRefuses, kSmallestPart},
    {LENSPROF_REASON_IMAGES_LEFT_OUT,          kWarns,   NAN},
    {LENSPROF_REASON_IMAGES_UNCONNECTED,       kWarns,   NAN},
    {LENSPROF_REASON_LINKS_CONTRADICT,         kNotes,   NAN},
    {LENSPROF_REASON_LINKS_UNVERIFIED,         kNotes,   NAN},
    // scene: two visits in different light
    {LENSPROF_REASON_IMAGE_GROUPS,             kRefuses, kVisitRatio},
    // methods/transfer_function: equal exposures have the identity as their transfer functions
    {LENSPROF_REASON_EXPOSURES_EQUAL,          kRefuses, kSmallestSpread},
    // methods/simpler.cpp: which model held-out pairs prefer; scene: and colours of points seen from many sides
    {LENSPROF_REASON_NOTHING_BETTER,           kRefuses, NAN},
    {LENSPROF_REASON_EXPOSURES_ONLY,           kRefuses, NAN},
    // methods/overlap.cpp: whether the pictures contradict a profile that is the prior (kClearlyWorse, kFarFromPrior)
    {LENSPROF_REASON_PRIOR_OVERRULED,          kWarns,   NAN},
    {LENSPROF_REASON_PRIOR_RESPONSE_OVERRULED, kWarns,   NAN},
    {LENSPROF_REASON_PRIOR_FALLOFF_OVERRULED,  kWarns,   NAN},
    // methods/unconstrained.cpp: whether they show the response at all (also kFewestGreys)
    {LENSPROF_REASON_RESPONSE_UNCONSTRAINED,   kNotes,   kSmallestLightSpread},
};
// clang-format on
constexpr size_t kMethodRuleCount = sizeof kMethodRules / sizeof *kMethodRules;

}  // namespace lensprof
