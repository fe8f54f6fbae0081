// The verdict on flat fields: all rules, the most important first within a severity. `limits.hpp` states where a limit
// comes from.
#pragma once

#include "fit/flat/fit.hpp"
#include "fit/flat/limits.hpp"
#include "fit/verdict/rule.hpp"

namespace lensprof {

// What is true of a flat field: a rule states what it needs.
enum FlatState : uint32_t {
    kOfAll = 0,
    kSloped = 1,     // the light varies over the card
    kSeparated = 2,  // rotated shots tell light from lens
    kNotSeparated = 4,
    kHasGrid = 8,
    kHasNoGrid = 16,
    kCenterByPrior = 32
};

struct JudgedFlat {
    const FlatFit &fit;
    const FlatResult &r;
    uint32_t state;
    Wording wording;

    JudgedFlat(const FlatFit &of, const FlatResult &result);
};

using FlatRule = VerdictRule<JudgedFlat>;

namespace measure {

Measured white_share(const JudgedFlat &judged);
Measured black_share(const JudgedFlat &judged);
Measured has_card(const JudgedFlat &judged);
Measured cells(const JudgedFlat &judged);
Measured card_radius(const JudgedFlat &judged);
Measured least_contrast(const JudgedFlat &judged);
Measured most_contrast(const JudgedFlat &judged);
Measured exposure_distance(const JudgedFlat &judged);
Measured texture(const JudgedFlat &judged);
Measured shot_difference(const JudgedFlat &judged);
Measured agreement(const JudgedFlat &judged);
Measured slope(const JudgedFlat &judged);
Measured convergence(const JudgedFlat &judged);
Measured covariance(const JudgedFlat &judged);
Measured corner_sigma(const JudgedFlat &judged);
Measured corner_sigma_not_radial(const JudgedFlat &judged);
Measured not_radial(const JudgedFlat &judged);
Measured not_radial_grid(const JudgedFlat &judged);
Measured center_distance(const JudgedFlat &judged);
Measured center_by_prior(const JudgedFlat &judged);
Measured spots(const JudgedFlat &judged);

}  // namespace measure

// clang-format off
#define REFUSES(code) LENSPROF_REASON_##code, LENSPROF_SEVERITY_REFUSAL
#define WARNS(code)   LENSPROF_REASON_##code, LENSPROF_SEVERITY_WARNING
#define NOTES(code)   LENSPROF_REASON_##code, LENSPROF_SEVERITY_NOTE

constexpr FlatRule kFlatRules[] = {
    // The pictures show no card, or only a part of it.
    {REFUSES(FLAT_WHITE),          kOfAll,                measure::white_share,              Side::above, flat_limits::kMuchClipped,         Wording::usual},
    {REFUSES(FLAT_BLACK),          kOfAll,                measure::black_share,              Side::above, flat_limits::kMuchClipped,         Wording::usual},
    {REFUSES(FLAT_NO_CARD),        kOfAll,                measure::has_card,                 Side::below, 1.0,                               Wording::usual},
    {REFUSES(FLAT_FEW_CELLS),      kOfAll,                measure::cells,                    Side::below, flat_limits::kMinCells,            Wording::usual},
    {REFUSES(SMALL_RADIUS),        kOfAll,                measure::card_radius,              Side::below, flat_limits::kSmallestRadius,      Wording::card},
    // They contradict the model.
    {REFUSES(FLAT_RESPONSE),       kOfAll,                measure::least_contrast,           Side::below, flat_limits::kSteepest,            Wording::less},
    {REFUSES(FLAT_RESPONSE),       kOfAll,                measure::most_contrast,            Side::above, flat_limits::kFlattest,            Wording::usual},
    {REFUSES(FLAT_EXPOSURE_WRONG), kOfAll,                measure::exposure_distance,        Side::above, flat_limits::kWrongEv,             Wording::usual},
    {REFUSES(FLAT_TEXTURE),        kOfAll,                measure::texture,                  Side::above, flat_limits::kMuchTexture,         Wording::usual},
    {REFUSES(FLAT_SHOTS_DIFFER),   kOfAll,                measure::shot_difference,          Side::above, flat_limits::kMuchPerShot,         Wording::usual},
    {REFUSES(FEW_AGREE),           kOfAll,                measure::agreement,                Side::below, flat_limits::kFewInliers,          Wording::card},
    {REFUSES(FLAT_STEEP),          kSloped|kSeparated,    measure::slope,                    Side::above, flat_limits::kSteepRotated,        Wording::usual},
    {REFUSES(FLAT_STEEP),          kSloped|kNotSeparated, measure::slope,                    Side::above, flat_limits::kSteepAlone,          Wording::alone},
    // They do not determine it.
    {REFUSES(NOT_CONVERGED),       kOfAll,                measure::convergence,              Side::below, 1.0,                               Wording::usual},
    {REFUSES(UNDETERMINED),        kOfAll,                measure::covariance,               Side::below, 1.0,                               Wording::card},
    {REFUSES(CORNER_UNCERTAIN),    kHasNoGrid,            measure::corner_sigma_not_radial,  Side::above, flat_limits::kLargestCornerSigma,  Wording::grid},
    {REFUSES(CORNER_UNCERTAIN),    kOfAll,                measure::corner_sigma,             Side::above, flat_limits::kLargestCornerSigma,  Wording::card},
    // The falloff may be wrong where people use it.
    {WARNS(SMALL_RADIUS),          kOfAll,                measure::card_radius,              Side::below, flat_limits::kWholeRadius,         Wording::weak},
    {WARNS(FLAT_EXPOSURE_WRONG),   kOfAll,                measure::exposure_distance,        Side::above, flat_limits::kDoubtfulEv,          Wording::weak},
    {WARNS(FLAT_STEEP),            kCenterByPrior,        measure::slope,                    Side::above, flat_limits::kSlantAlone,          Wording::weak},
    // Worth knowing.
    {NOTES(FLAT_WHITE),            kOfAll,                measure::white_share,              Side::above, flat_limits::kSomeClipped,         Wording::weak},
    {NOTES(FLAT_BLACK),            kOfAll,                measure::black_share,              Side::above, flat_limits::kSomeClipped,         Wording::weak},
    {NOTES(FLAT_SHOTS_DIFFER),     kOfAll,                measure::shot_difference,          Side::above, flat_limits::kSomePerShot,         Wording::weak},
    {NOTES(FLAT_TEXTURE),          kOfAll,                measure::texture,                  Side::above, flat_limits::kSomeTexture,         Wording::weak},
    {NOTES(FLAT_NOT_RADIAL),       kHasGrid,              measure::not_radial_grid,          Side::above, flat_limits::kNotRadial,           Wording::grid},
    {NOTES(FLAT_NOT_RADIAL),       kHasNoGrid,            measure::not_radial,               Side::above, flat_limits::kNotRadial,           Wording::usual},
    {NOTES(FAR_CENTER),            kOfAll,                measure::center_distance,          Side::above, flat_limits::kFarCenter,           Wording::card},
    {NOTES(FLAT_CENTER_BY_PRIOR),  kCenterByPrior,        measure::center_by_prior,          Side::above, 0.0,                               Wording::usual},
    {NOTES(FLAT_DUST),             kOfAll,                measure::spots,                    Side::above, 0.0,                               Wording::usual},
};
// clang-format on
constexpr size_t kFlatRuleCount = sizeof kFlatRules / sizeof *kFlatRules;

#undef REFUSES
#undef WARNS
#undef NOTES

}  // namespace lensprof
