// The verdict on a flat field: why it is not usable, or the warning about it.
#include <algorithm>
#include <cmath>

#include "fit/base/quantile.hpp"
#include "fit/flat/fit.hpp"
#include "fit/verdict/reason.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kMinCells = 60;
constexpr double kSmallestRadius = 0.6, kWholeRadius = 0.9;   // half diagonals
constexpr double kMuchClipped = 0.2, kSomeClipped = 0.005;    // of the card, white or black in every exposure
constexpr double kLargestCornerSigma = 0.01;                  // of M
constexpr double kMuchTexture = 0.01, kSomeTexture = 0.005;   // of the light
constexpr double kSteepAlone = 0.2, kSlantAlone = 0.1;        // of the light per half diagonal, not rotated:
constexpr double kSteepTurned = 0.5;                          // its square is about the error of a plane
constexpr double kMuchPerShot = 0.015, kSomePerShot = 0.004;  // of the light
constexpr double kNotRadial = 0.003;                          // of the light
constexpr double kWrongEv = 0.3, kDoubtfulEv = 0.1;           // EV, within a shot
constexpr double kSteepest = 0.05, kFlattest = 20.0;          // d ln E / d ln B; of cameras .2 to 10
constexpr double kFewInliers = 0.5;
constexpr double kFarCentre = 0.1;  // half diagonals, as for the overlap fit

// The worst of the shots in some respect.
struct Worst {
    double value = 0.0;
    uint32_t shot = 0;

    void take(double other, uint32_t number) {
        if (other > value) value = other, shot = number;
    }
};

// Share of a shot's card that is white (or black) in every exposure.
Worst worst_share_in(const FlatFit &fit, CellState state) {
    Worst worst;
    for (const Shot &shot : fit.shots) {
        double card = 0.0, lost = 0.0;
        for (size_t i = 0; i < shot.card.size(); i++)
            if (shot.card[i]) card += 1.0, lost += shot.light[i].state == state;
        if (card > 0.0) worst.take(lost / card, shot.number);
    }
    return worst;
}

// Finds a shot without a card; false if all shots have one.
bool lacks_card(const FlatFit &fit, uint32_t &number) {
    for (const Shot &shot : fit.shots)
        if (number = shot.number; std::find(shot.card.begin(), shot.card.end(), true) == shot.card.end()) return true;
    return false;
}

Worst steepest(const FlatFit &fit) {
    Worst worst;
    for (size_t s = 0; s < fit.shots.size(); s++) {
        auto slope = light_gradient(fit.problem.model, fit.estimate.u, static_cast<int>(s));
        worst.take(std::hypot(slope[0], slope[1]), fit.shots[s].number);
    }
    return worst;
}

// The picture whose exposure differs most from the others of its shot, by its index.
Worst wrong_exposure(const FlatFit &fit, const FlatResult &r) {
    Worst worst;
    for (uint32_t i = 0; i < fit.count && r.image_quality; i++) worst.take(std::abs(r.image_quality[i].ev_residual), i);
    return worst;
}

// Change of a picture's light with its grey values, d ln E / d ln B: median over cells and channels.
double contrast_of_light(const FlatFit &fit, uint32_t image) {
    Responses responses(fit.options);
    std::vector<double> contrasts;
    for (const Cell &cell : fit.pictures[image].cells) {
        for (uint32_t c = 0; cell.state == CellState::used && c < fit.options.channels; c++) {
            double grey = static_cast<double>(cell.value[c]), slope = 0.0;
            double light = responses.invert(static_cast<int>(c), grey, &slope);
            if (light > 0.0) contrasts.push_back(slope * grey / light);
        }
    }
    return contrasts.empty() ? 1.0 : median(contrasts);
}

// Whether the response has almost no gradation in the range of the picture's grey values.
bool has_no_gradation(const FlatFit &fit, FlatResult &r) {
    for (uint32_t i = 0; i < fit.count; i++) {
        double contrast = contrast_of_light(fit, i);
        if (contrast < kSteepest) return refuse(r, of_image(LENSPROF_REASON_FLAT_RESPONSE_STEP, i, {contrast}));
        if (contrast > kFlattest) return refuse(r, of_image(LENSPROF_REASON_FLAT_RESPONSE_LEVEL, i, {contrast}));
    }
    return false;
}

bool lacks_light(const FlatFit &fit, FlatResult &r) {
    Worst white = worst_share_in(fit, CellState::white), black = worst_share_in(fit, CellState::black);
    if (white.value > kMuchClipped) return refuse(r, of_shot(LENSPROF_REASON_FLAT_WHITE, white.shot, {white.value}));
    if (black.value > kMuchClipped) return refuse(r, of_shot(LENSPROF_REASON_FLAT_BLACK, black.shot, {black.value}));
    uint32_t number;
    if (lacks_card(fit, number)) return refuse(r, of_shot(LENSPROF_REASON_FLAT_NO_CARD, number));
    if (r.cells < kMinCells) return refuse(r, {LENSPROF_REASON_FLAT_FEW_CELLS, {double(r.cells)}});
    if (r.radius < kSmallestRadius) return refuse(r, {LENSPROF_REASON_FLAT_SMALL_RADIUS, {r.radius}});
    return false;
}

bool contradicts_model(const FlatFit &fit, FlatResult &r) {
    Worst wrong = wrong_exposure(fit, r), steep = steepest(fit);
    if (wrong.value > kWrongEv)
        return refuse(r, of_image(LENSPROF_REASON_FLAT_EXPOSURE_WRONG, wrong.shot, {wrong.value}));
    if (r.texture > kMuchTexture) return refuse(r, {LENSPROF_REASON_FLAT_TEXTURE, {r.texture}});
    if (r.shot_residual > kMuchPerShot) return refuse(r, {LENSPROF_REASON_FLAT_SHOTS_DIFFER, {r.shot_residual}});
    if (r.inlier_share < kFewInliers) return refuse(r, {LENSPROF_REASON_FLAT_FEW_AGREE, {r.inlier_share}});
    const bool plane = fit.problem.model.light_terms > 0;
    if (plane && steep.value > (r.separated ? kSteepTurned : kSteepAlone))
        return refuse(r, of_shot(r.separated ? LENSPROF_REASON_FLAT_STEEP : LENSPROF_REASON_FLAT_STEEP_ALONE,
                                 steep.shot, {steep.value}));
    return false;
}

bool is_undetermined(const FlatFit &fit, FlatResult &r) {
    if (!r.converged) return refuse(r, {LENSPROF_REASON_NOT_SETTLED, {double(r.iterations)}});
    if (fit.covariance.size() == 0) return refuse(r, {LENSPROF_REASON_FLAT_UNDETERMINED, {}});
    // A residual that is not radial makes the polynomial uncertain, but not the product of polynomial and grid.
    const bool radial = r.frame_residual < kNotRadial;
    if (r.corner_sigma > kLargestCornerSigma && !radial && !r.gain_grid.columns)
        return refuse(r, {LENSPROF_REASON_FLAT_CORNER_NOT_RADIAL, {r.frame_residual, r.corner_sigma}});
    if (r.corner_sigma > kLargestCornerSigma && radial)
        return refuse(r, {LENSPROF_REASON_FLAT_CORNER_UNCERTAIN, {r.corner_sigma}});
    return false;
}

// The most important warning about the card and the pictures.
bool warns_of_card(const FlatFit &fit, FlatResult &r) {
    Worst wrong = wrong_exposure(fit, r), white = worst_share_in(fit, CellState::white),
          black = worst_share_in(fit, CellState::black);
    if (r.radius < kWholeRadius) return warn(r, {LENSPROF_REASON_FLAT_EXTRAPOLATED, {r.radius}});
    if (white.value > kSomeClipped && white.value > black.value)
        return warn(r, of_shot(LENSPROF_REASON_FLAT_SOME_WHITE, white.shot, {white.value}));
    if (black.value > kSomeClipped) return warn(r, of_shot(LENSPROF_REASON_FLAT_SOME_BLACK, black.shot, {black.value}));
    if (wrong.value > kDoubtfulEv)
        return warn(r, of_image(LENSPROF_REASON_FLAT_EXPOSURE_DOUBTFUL, wrong.shot, {wrong.value}));
    if (r.shot_residual > kSomePerShot) return warn(r, {LENSPROF_REASON_FLAT_SHOTS_DIFFER_SOME, {r.shot_residual}});
    return r.texture > kSomeTexture && warn(r, {LENSPROF_REASON_FLAT_SOME_TEXTURE, {r.texture}});
}

// The most important warning about light and lens.
bool warns_of_light(const FlatFit &fit, FlatResult &r) {
    const auto &centre = r.vignetting[0].center;
    const double off_centre = std::hypot(centre[0], centre[1]), slant = steepest(fit).value;
    const bool by_prior =
        fit.problem.model.light_terms > 0 && !r.separated && (fit.options.free & LENSPROF_FREE_CENTER);
    if (by_prior && slant > kSlantAlone) return warn(r, {LENSPROF_REASON_FLAT_SLANTED_LIGHT, {slant}});
    if (r.frame_residual > kNotRadial && r.gain_grid.columns)
        return warn(r, {LENSPROF_REASON_FLAT_NOT_RADIAL_GRID, {r.frame_residual, r.grid_residual}});
    if (r.frame_residual > kNotRadial) return warn(r, {LENSPROF_REASON_FLAT_NOT_RADIAL, {r.frame_residual}});
    if (off_centre > kFarCentre) return warn(r, {LENSPROF_REASON_FLAT_FAR_CENTER, {off_centre}});
    if (by_prior) return warn(r, {LENSPROF_REASON_FLAT_CENTER_BY_PRIOR, {}});
    return r.spots && warn(r, {LENSPROF_REASON_FLAT_DUST, {double(r.spots)}});
}

}  // namespace

void judge_flat(const FlatFit &fit, FlatResult &r) {
    if (lacks_light(fit, r) || has_no_gradation(fit, r) || contradicts_model(fit, r) || is_undetermined(fit, r)) return;
    accept(r);
    if (!warns_of_card(fit, r)) warns_of_light(fit, r);
}

}  // namespace lensprof
