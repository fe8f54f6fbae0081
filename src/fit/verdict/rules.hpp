// The verdict on fits: all rules, the most important first within a severity. `limits.hpp` states where a limit
// comes from.
#pragma once

#include "falloff/rise.hpp"
#include "fit/problem/curve_shape.hpp"
#include "fit/verdict/limits.hpp"
#include "fit/verdict/measures.hpp"

namespace lensprof {

// clang-format off
#define REFUSES(code) LENSPROF_REASON_##code, LENSPROF_SEVERITY_REFUSAL
#define WARNS(code)   LENSPROF_REASON_##code, LENSPROF_SEVERITY_WARNING
#define NOTES(code)   LENSPROF_REASON_##code, LENSPROF_SEVERITY_NOTE

constexpr FitRule kRules[] = {
    // Pairs are too few, too similar, or at places that carry no information.
    {REFUSES(IMAGE_GROUPS),        kStatic,                 measure::groups,             Side::above, 1.0,                    Wording::usual},
    {REFUSES(FEW_PAIRS),           kAlways,                 measure::pairs_per_unknown,  Side::below, kPairsPerUnknown,       Wording::usual},
    {REFUSES(EXPOSURES_EQUAL),     kStatic|kFreesResponse,  measure::exposure_spread,    Side::below, kSmallestSpread,        Wording::usual},
    {REFUSES(FEW_GREYS),           kFreesResponse,          measure::covered_greys,      Side::below, kMinGreys,              Wording::usual},
    {REFUSES(SAME_VIEW),           kMoving|kFreesFalloff,   measure::radius_change,      Side::below, kSameView,              Wording::usual},
    {REFUSES(SMALL_RADIUS),        kFreesFalloff,           measure::covered_radius,     Side::below, kSmallestRadius,        Wording::usual},
    // They contradict every camera.
    {REFUSES(FEW_AGREE),           kStill,                  measure::still_agreement,    Side::below, kSmallestStillAgreement, Wording::still},
    {REFUSES(FEW_AGREE),           kAlways,                 measure::agreement,          Side::below, kSmallestAgreement,     Wording::usual},
    {REFUSES(PATTERNS),            kStill,                  measure::strong_pattern,     Side::above, kHarmfulStillPattern,   Wording::still},
    {REFUSES(PATTERNS),            kNotStill|kFreesAll,     measure::strong_pattern,     Side::above, kHarmfulPattern,        Wording::usual},
    {REFUSES(PATTERNS),            kNotStill|kHolds,        measure::strong_pattern,     Side::above, kSmallestPattern,       Wording::held},
    {REFUSES(SCATTER),             kAlways,                 measure::noise,              Side::above, kLargestNoise,          Wording::usual},
    // They do not determine the result.
    {REFUSES(NOT_CONVERGED),       kAlways,                 measure::convergence,        Side::below, 1.0,                    Wording::usual},
    {REFUSES(UNDETERMINED),        kAlways,                 measure::covariance,         Side::below, 1.0,                    Wording::usual},
    {REFUSES(CORNER_UNCERTAIN),    kAlways,                 measure::corner_sigma,       Side::above, kLargestCornerSigma,    Wording::usual},
    {REFUSES(CENTER_ON_LIMIT),     kFreesCenter,            measure::center_on_axis,     Side::above, kOnLimit*kLargestCenter, Wording::usual},
    {REFUSES(FALLOFF_RISES),       kAlways,                 measure::clear_rise,         Side::above, kLargestRise,           Wording::usual},
    {REFUSES(FALLOFF_DARK),        kFreesFalloff,           measure::darkest,            Side::below, kSmallestM,             Wording::usual},
    {REFUSES(FEW_INLIERS),         kAlways,                 measure::image_inliers,      Side::below, kMinInliers,            Wording::usual},
    {REFUSES(IMAGE_DISAGREES),     kAlways,                 measure::image_agreement,    Side::below, kSmallestImageShare,    Wording::usual},
    {REFUSES(EXPOSURE_UNCERTAIN),  kAlways,                 measure::exposure_sigma,     Side::above, kLargestEvSigma,        Wording::usual},
    // The pictures still show it, or a number that people use is wrong.
    {WARNS(WHITE_BALANCE_FIXED),   kAlways,                 measure::held_white_balance, Side::above, 0.0,                    Wording::usual},
    {WARNS(IMAGE_INCONSISTENT),    kAlways,                 measure::image_residual,     Side::above, kInconsistentImage,     Wording::usual},
    {WARNS(KNOWN_ORDER),           kAlways,                 measure::known_order,        Side::above, 0.0,                    Wording::usual},
    {WARNS(KNOWN_STEP),            kAlways,                 measure::known_step_up,      Side::above, 0.0,                    Wording::usual},
    {WARNS(KNOWN_STEP),            kAlways,                 measure::known_step_down,    Side::above, 0.0,                    Wording::less},
    {WARNS(GAMMA_INCONSISTENT),    kAlways,                 measure::gamma_inconsistency, Side::above, kInconsistentGamma,           Wording::usual},
    {WARNS(PATTERNS),              kStill,                  measure::weak_pattern,       Side::above, kStillPattern,          Wording::weak},
    {WARNS(PATTERNS),              kNotStill,               measure::weak_pattern,       Side::above, kSmallestPattern,       Wording::weak},
    {WARNS(SEAMS_REMAIN),          kHasSeams,               measure::seam,               Side::above, kSeen,                  Wording::usual},
    // Worth knowing.
    {NOTES(KNOWN_WRONG),           kAlways,                 measure::known_single,       Side::above, 0.0,                    Wording::usual},
    {NOTES(KNOWN_WRONG),           kLeavesOutKnown,         measure::known_outlier,      Side::above, 0.0,                    Wording::usual},
    {NOTES(KNOWN_WRONG),           kAlways,                 measure::known_outlier,      Side::above, kContradiction,         Wording::usual},
    {NOTES(KNOWN_CONTRADICT),      kAlways,                 measure::known_any,          Side::above, 0.0,                    Wording::usual},
    {NOTES(NOT_RADIAL),            kAlways,                 measure::frame_pattern,      Side::above, kSmallestPattern,       Wording::usual},
    {NOTES(FALLOFF_RISES),         kAlways,                 measure::clear_rise,         Side::above, 1.0+kSmallRise,         Wording::weak},
    {NOTES(FAR_CENTER),            kFreesCenter,            measure::center_distance,    Side::above, kFarCenter,             Wording::usual},
    {NOTES(MISSING_GREYS),         kFreesResponse,          measure::missing_greys,      Side::below, kEnoughGreys,           Wording::usual},
    {NOTES(UNUSUAL_RESPONSE),      kAlways,                 measure::response_oddness,   Side::above, kUnusual,               Wording::usual},
    {NOTES(MANY_OUTLIERS),         kHasSeams,               measure::outliers,           Side::above, 1.0-kSmallestShare,         Wording::usual},
    {NOTES(MANY_OUTLIERS),         kHasSeams,               measure::heldout_rms,        Side::above, kLargestRms,            Wording::usual},
    {NOTES(SEAMS_REMAIN),          kHasSeams,               measure::seam,               Side::above, 0.0,                    Wording::usual},
};
// clang-format on
constexpr size_t kRuleCount = sizeof kRules / sizeof *kRules;

#undef REFUSES
#undef WARNS
#undef NOTES

}  // namespace lensprof
