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
    kCenterByPrior = 32,
    kFewAngles = 64,  // of shots: they do not separate the light from a lens that is not radial
    kOneAngle = 128,  // one light and one angle
    kEvenChosen = 256,
    kPlaneChosen = 512,
    kBlackShown = 1024,  // by the pictures
    kManyShots = 2048    // more than two: one of them can differ from the others
};

struct JudgedFlat {
    const FlatFit &fit;
    const FlatResult &r;
    uint32_t state;
    Wording wording;
    std::vector<double> contrasts;  // of light, per picture

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
Measured odd_shot(const JudgedFlat &judged);
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
Measured image_circle(const JudgedFlat &judged);
Measured cover(const JudgedFlat &judged);
Measured one_light(const JudgedFlat &judged);
Measured polynomial_error(const JudgedFlat &judged);
Measured black_error(const JudgedFlat &judged);
Measured black_offset(const JudgedFlat &judged);

}  // namespace measure

// clang-format off
constexpr FlatRule kFlatRules[] = {
    // The pictures show no card, or only a part of it.
    {LENSPROF_REASON_FLAT_WHITE,           kRefuses, kOfAll,                measure::white_share,             Side::above, flat_limits::kMuchClipped,        Wording::usual},
    {LENSPROF_REASON_FLAT_BLACK,           kRefuses, kOfAll,                measure::black_share,             Side::above, flat_limits::kMuchClipped,        Wording::usual},
    {LENSPROF_REASON_FLAT_NO_CARD,         kRefuses, kOfAll,                measure::has_card,                Side::below, 1.0,                              Wording::usual},
    {LENSPROF_REASON_FLAT_FEW_CELLS,       kRefuses, kOfAll,                measure::cells,                   Side::below, flat_limits::kMinCells,           Wording::usual},
    {LENSPROF_REASON_SMALL_RADIUS,         kRefuses, kOfAll,                measure::card_radius,             Side::below, flat_limits::kSmallestRadius,     Wording::card},
    // They contradict the model.
    {LENSPROF_REASON_FLAT_RESPONSE,        kRefuses, kOfAll,                measure::least_contrast,          Side::below, flat_limits::kSteepest,           Wording::less},
    {LENSPROF_REASON_FLAT_RESPONSE,        kRefuses, kOfAll,                measure::most_contrast,           Side::above, flat_limits::kFlattest,           Wording::usual},
    {LENSPROF_REASON_FLAT_EXPOSURE_WRONG,  kRefuses, kOfAll,                measure::exposure_distance,       Side::above, flat_limits::kWrongEv,            Wording::usual},
    {LENSPROF_REASON_FLAT_TEXTURE,         kRefuses, kOfAll,                measure::texture,                 Side::above, flat_limits::kMuchTexture,        Wording::usual},
    {LENSPROF_REASON_FLAT_SHOTS_DIFFER,    kRefuses, kManyShots,            measure::odd_shot,                Side::above, flat_limits::kMuchPerShot,        Wording::odd},
    {LENSPROF_REASON_FLAT_SHOTS_DIFFER,    kRefuses, kOfAll,                measure::shot_difference,         Side::above, flat_limits::kMuchPerShot,        Wording::usual},
    {LENSPROF_REASON_FEW_AGREE,            kRefuses, kOfAll,                measure::agreement,               Side::below, flat_limits::kFewInliers,         Wording::card},
    {LENSPROF_REASON_FLAT_STEEP,           kRefuses, kSloped|kSeparated,    measure::slope,                   Side::above, flat_limits::kSteepRotated,       Wording::usual},
    {LENSPROF_REASON_FLAT_STEEP,           kRefuses, kSloped|kNotSeparated, measure::slope,                   Side::above, flat_limits::kSteepAlone,         Wording::alone},
    // They do not determine it.
    {LENSPROF_REASON_NOT_CONVERGED,        kRefuses, kOfAll,                measure::convergence,             Side::below, 1.0,                              Wording::usual},
    {LENSPROF_REASON_UNDETERMINED,         kRefuses, kOfAll,                measure::covariance,              Side::below, 1.0,                              Wording::card},
    {LENSPROF_REASON_CORNER_UNCERTAIN,     kRefuses, kFewAngles|kHasNoGrid, measure::corner_sigma_not_radial, Side::above, flat_limits::kLargestCornerSigma, Wording::alone},
    {LENSPROF_REASON_CORNER_UNCERTAIN,     kRefuses, kHasNoGrid,            measure::corner_sigma_not_radial, Side::above, flat_limits::kLargestCornerSigma, Wording::grid},
    {LENSPROF_REASON_CORNER_UNCERTAIN,     kRefuses, kOfAll,                measure::corner_sigma,            Side::above, flat_limits::kLargestCornerSigma, Wording::card},
    // The falloff may be wrong where people use it.
    {LENSPROF_REASON_SMALL_RADIUS,         kWarns,   kOfAll,                measure::card_radius,             Side::below, flat_limits::kWholeRadius,        Wording::weak},
    {LENSPROF_REASON_FLAT_EXPOSURE_WRONG,  kWarns,   kOfAll,                measure::exposure_distance,       Side::above, flat_limits::kDoubtfulEv,         Wording::weak},
    {LENSPROF_REASON_FLAT_STEEP,           kWarns,   kCenterByPrior,        measure::slope,                   Side::above, flat_limits::kSlantAlone,         Wording::weak},
    {LENSPROF_REASON_FLAT_NOT_RADIAL,      kWarns,   kFewAngles|kHasGrid,   measure::not_radial_grid,         Side::above, flat_limits::kMuchNotRadial,      Wording::alone_grid},
    {LENSPROF_REASON_FLAT_NOT_RADIAL,      kWarns,   kFewAngles|kHasNoGrid, measure::not_radial,              Side::above, flat_limits::kMuchNotRadial,      Wording::alone},
    {LENSPROF_REASON_FLAT_NEEDS_GRID,      kWarns,   kHasNoGrid,            measure::polynomial_error,        Side::above, flat_limits::kNotPolynomial,      Wording::alone},
    // Worth knowing.
    {LENSPROF_REASON_FLAT_EDGE,            kNotes,   kOfAll,                measure::image_circle,            Side::above, 0.0,                              Wording::usual},
    {LENSPROF_REASON_FLAT_EDGE,            kNotes,   kOfAll,                measure::cover,                    Side::above, 0.0,                              Wording::weak},
    {LENSPROF_REASON_FLAT_WHITE,           kNotes,   kOfAll,                measure::white_share,             Side::above, flat_limits::kSomeClipped,        Wording::weak},
    {LENSPROF_REASON_FLAT_BLACK,           kNotes,   kOfAll,                measure::black_share,             Side::above, flat_limits::kSomeClipped,        Wording::weak},
    {LENSPROF_REASON_FLAT_SHOTS_DIFFER,    kNotes,   kManyShots,            measure::odd_shot,                Side::above, flat_limits::kSomePerShot,        Wording::less},
    {LENSPROF_REASON_FLAT_SHOTS_DIFFER,    kNotes,   kOfAll,                measure::shot_difference,         Side::above, flat_limits::kSomePerShot,        Wording::weak},
    {LENSPROF_REASON_FLAT_TEXTURE,         kNotes,   kOfAll,                measure::texture,                 Side::above, flat_limits::kSomeTexture,        Wording::weak},
    {LENSPROF_REASON_FLAT_NOT_RADIAL,      kNotes,   kHasGrid,              measure::not_radial_grid,         Side::above, flat_limits::kNotRadial,          Wording::grid},
    {LENSPROF_REASON_FLAT_NOT_RADIAL,      kNotes,   kHasNoGrid,            measure::not_radial,              Side::above, flat_limits::kNotRadial,          Wording::usual},
    {LENSPROF_REASON_FAR_CENTER,           kNotes,   kOfAll,                measure::center_distance,         Side::above, flat_limits::kFarCenter,          Wording::card},
    {LENSPROF_REASON_FLAT_NEEDS_GRID,      kNotes,   kHasGrid,              measure::polynomial_error,        Side::above, flat_limits::kNotPolynomial,      Wording::weak},
    {LENSPROF_REASON_FLAT_CENTER_BY_PRIOR, kNotes,   kCenterByPrior|kPlaneChosen, measure::center_by_prior,   Side::above, 0.0,                              Wording::weak},
    {LENSPROF_REASON_FLAT_CENTER_BY_PRIOR, kNotes,   kCenterByPrior|kEvenChosen,  measure::center_by_prior,   Side::above, 0.0,                              Wording::less},
    {LENSPROF_REASON_FLAT_CENTER_BY_PRIOR, kNotes,   kCenterByPrior,        measure::center_by_prior,         Side::above, 0.0,                              Wording::held},
    {LENSPROF_REASON_FLAT_DUST,            kNotes,   kOfAll,                measure::spots,                   Side::above, 0.0,                              Wording::usual},
    {LENSPROF_REASON_FLAT_BLACK_LEVEL,     kNotes,   kOfAll,                measure::black_error,             Side::above, flat_limits::kUncertainEv,        Wording::usual},
    {LENSPROF_REASON_FLAT_BLACK_LEVEL,     kNotes,   kBlackShown,           measure::black_offset,            Side::above, flat_limits::kClearOffset,        Wording::weak},
    {LENSPROF_REASON_FLAT_ONE_LIGHT,       kNotes,   kOneAngle,             measure::one_light,               Side::above, 0.0,                              Wording::usual},
};
// clang-format on
constexpr size_t kFlatRuleCount = sizeof kFlatRules / sizeof *kFlatRules;

}  // namespace lensprof
