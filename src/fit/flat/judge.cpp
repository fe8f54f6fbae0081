// What the verdict on a flat field measures, and its rules.
#include <algorithm>
#include <cmath>

#include "fit/base/quantile.hpp"
#include "fit/flat/fit.hpp"
#include "fit/flat/rules.hpp"

namespace lensprof {
namespace {

// Angles of shots that separate light from a lens that is not radial: two shots can have one pattern in common.
constexpr size_t kTellingAngles = 3;

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

// Whether the slope is that of the plane that was not chosen.
bool is_slope_of_other(const FlatFit &fit) { return fit.light == LENSPROF_FLAT_LIGHT_EVEN && fit.other; }

// A centre off leaves no pattern, where a slope that the model lacks leaves one.
bool has_pattern_of_slope(const FlatResult &r) { return r.frame_residual > flat_limits::kPatternOfSlope; }

// What counts of such a slope: no more than the centre of the even light explains, which the pictures show better than
// they show a plane. A centre off by dc looks like the slope dc |d ln M / dr|, and lenses have the same dc whatever
// their falloff: slopes in falloffs deeper than two stops count as in one of two, unless they leave their pattern.
double counted_slope(const FlatFit &fit, const FlatResult &r, double slope) {
    constexpr double usual_stops = 2.0;
    const double stops = r.corner > 0.0 ? -std::log2(r.corner) : usual_stops;
    if (!is_slope_of_other(fit) || stops <= usual_stops) return slope;
    const double *center = r.vignetting[0].center, steepness = 2.0 * stops * std::log(2.0);
    const double explained = std::min(slope, steepness * std::hypot(center[0], center[1]));
    return has_pattern_of_slope(r) ? explained : explained * usual_stops / stops;
}

Worst steepest(const FlatFit &fit) {
    Worst worst;
    const bool is_other = is_slope_of_other(fit);
    for (size_t s = 0; s < fit.shots.size(); s++) {
        auto slope = is_other ? light_gradient(fit.other->problem.model, fit.other->estimate.u, static_cast<int>(s))
                              : light_gradient(fit.problem.model, fit.estimate.u, static_cast<int>(s));
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

uint32_t state_of(const FlatFit &fit, const FlatResult &r) {
    const bool is_sloped = fit.problem.model.light_terms > 0 || (is_slope_of_other(fit) && has_pattern_of_slope(r));
    const bool is_even = fit.light == LENSPROF_FLAT_LIGHT_EVEN;
    uint32_t state = r.separated ? kSeparated : kNotSeparated;
    state |= r.gain_grid.columns ? kHasGrid : kHasNoGrid;
    if (is_sloped) state |= kSloped;
    if (is_sloped && fit.problem.model.angles() < kTellingAngles) state |= kFewAngles;
    if ((is_sloped || fit.other) && !r.separated && (fit.options.free & LENSPROF_FREE_CENTER)) state |= kCenterByPrior;
    if (!fit.options.several && fit.problem.model.angles() == 1) state |= kOneAngle;
    if (r.black_shown) state |= kBlackShown;
    if (fit.shots.size() > 2) state |= kManyShots;
    if (fit.other) state |= is_even ? kEvenChosen : kPlaneChosen;
    return state;
}

// Adds the mean place of a shot's cells in a state, half diagonals from the middle, and the error in the corner.
Measured with_place(const JudgedFlat &judged, const Worst &worst, CellState state) {
    Measured measured = of_shot(of_value(worst.value), worst.shot);
    double count = 0.0, x = 0.0, y = 0.0;
    const CellGrid &grid = judged.fit.grid;
    for (const Shot &shot : judged.fit.shots)
        for (int i = 0; i < grid.count() && shot.number == worst.shot; i++) {
            const auto cell = static_cast<size_t>(i);
            if (!shot.card[cell] || shot.light[cell].state != state) continue;
            const auto middle = grid.middle(i);
            count += 1.0, x += middle[0] - 0.5 * grid.width, y += middle[1] - 0.5 * grid.height;
        }
    const double half = std::max(count, 1.0) * lensprof_half_diagonal(grid.width, grid.height);
    measured.values = {worst.value, x / half, y / half, judged.r.corner_sigma};
    return measured;
}

}  // namespace

JudgedFlat::JudgedFlat(const FlatFit &of, const FlatResult &result)
    : fit(of), r(result), state(state_of(of, result)), wording(Wording::card) {
    for (uint32_t i = 0; i < of.count; i++) contrasts.push_back(contrast_of_light(of, i));
}

namespace measure {

Measured white_share(const JudgedFlat &judged) {
    return with_place(judged, worst_share_in(judged.fit, CellState::white), CellState::white);
}

Measured black_share(const JudgedFlat &judged) {
    return with_place(judged, worst_share_in(judged.fit, CellState::black), CellState::black);
}

Measured has_card(const JudgedFlat &judged) {
    uint32_t number = 0;
    const double has = lacks_card(judged.fit, number) ? 0.0 : 1.0;
    return of_shot({has, 0, {}}, number);
}

Measured cells(const JudgedFlat &judged) { return of_value(judged.r.cells); }

// If the data end at an edge, what reaches it is whole.
Measured card_radius(const JudgedFlat &judged) {
    const double inner = judged.fit.edge.inner;
    Measured measured = of_value(judged.r.radius);
    if (inner > 0.0) measured.value = std::min(1.0, judged.r.radius / inner);
    return measured;
}

// Contrasts of light have the number of their picture.
Measured least_contrast(const JudgedFlat &judged) {
    const auto least = std::min_element(judged.contrasts.begin(), judged.contrasts.end());
    return of_image(of_value(*least), static_cast<uint32_t>(least - judged.contrasts.begin()));
}

Measured most_contrast(const JudgedFlat &judged) {
    const auto most = std::max_element(judged.contrasts.begin(), judged.contrasts.end());
    return of_image(of_value(*most), static_cast<uint32_t>(most - judged.contrasts.begin()));
}

Measured exposure_distance(const JudgedFlat &judged) {
    const Worst wrong = wrong_exposure(judged.fit, judged.r);
    return of_image(of_value(wrong.value), wrong.shot);
}

// The share of the corner's error that texture has: errors add up by their squares.
Measured texture(const JudgedFlat &judged) {
    const FlatResult &r = judged.r;
    return of_values(r.texture, r.texture, r.corner_sigma * r.texture / std::hypot(r.texture, r.noise));
}

Measured shot_difference(const JudgedFlat &judged) { return of_value(judged.r.shot_residual); }

Measured odd_shot(const JudgedFlat &judged) { return of_shot(shot_difference(judged), judged.r.odd_shot); }

Measured agreement(const JudgedFlat &judged) { return of_value(judged.r.inlier_share); }

Measured slope(const JudgedFlat &judged) {
    const Worst steep = steepest(judged.fit);
    Measured measured = of_shot(of_value(steep.value), steep.shot);
    measured.value = counted_slope(judged.fit, judged.r, steep.value);
    return measured;
}

Measured convergence(const JudgedFlat &judged) {
    return {double(judged.r.converged), 1, {double(judged.r.iterations)}};
}

Measured covariance(const JudgedFlat &judged) { return {double(judged.fit.covariance.size()), 0, {}}; }

// A residual that is not radial makes the polynomial uncertain, but not the product of polynomial and grid. The black
// level has a note of its own.
Measured corner_sigma(const JudgedFlat &judged) {
    const FlatResult &r = judged.r;
    if (r.frame_residual >= flat_limits::kNotRadial) return {};
    return of_value(r.sigma_without_black);
}

Measured corner_sigma_not_radial(const JudgedFlat &judged) {
    const FlatResult &r = judged.r;
    if (r.frame_residual < flat_limits::kNotRadial) return {};
    return of_values(r.sigma_without_black, r.sigma_without_black, r.frame_residual);
}

Measured not_radial(const JudgedFlat &judged) { return of_value(judged.r.frame_residual); }

Measured not_radial_grid(const JudgedFlat &judged) {
    return of_values(judged.r.frame_residual, judged.r.frame_residual, judged.r.grid_residual);
}

Measured center_distance(const JudgedFlat &judged) {
    const double *center = judged.r.vignetting[0].center;
    return of_value(std::hypot(center[0], center[1]));
}

Measured center_by_prior(const JudgedFlat &judged) { return {1.0, 1, {judged.r.light_ev}}; }

Measured spots(const JudgedFlat &judged) {
    const FlatResult &r = judged.r;
    double share = 0.0;
    for (const auto &left_out : judged.fit.left_out)
        share += static_cast<double>(std::count(left_out.begin(), left_out.end(), true)) / judged.fit.grid.count()
                 / static_cast<double>(judged.fit.left_out.size());
    const auto spots = static_cast<double>(r.spots);
    return {spots, 2, {spots, r.corner_sigma, share, r.spot[0].x, r.spot[0].y}};
}

Measured image_circle(const JudgedFlat &judged) {
    return of_values(judged.r.image_circle.radius, judged.r.image_circle.radius, judged.r.edge_share);
}

Measured cover(const JudgedFlat &judged) {
    const double radius = judged.r.image_circle.radius > 0.0 ? 0.0 : judged.r.edge_radius;
    return of_values(radius, radius, judged.r.edge_share);
}

Measured one_light(const JudgedFlat &) { return {1.0, 0, {}}; }

Measured black_error(const JudgedFlat &judged) {
    return of_values(judged.r.black_ev, judged.r.black_sigma, judged.r.black_ev);
}

Measured black_offset(const JudgedFlat &judged) {
    const FlatResult &r = judged.r;
    return of_values(std::abs(r.black_offset) / r.black_sigma, r.black_offset, r.black_sigma);
}

Measured polynomial_error(const JudgedFlat &judged) { return of_value(judged.r.polynomial_error); }

}  // namespace measure

void judge_flat(const FlatFit &fit, FlatResult &r) {
    r.verdict.clear();
    apply_rules(kFlatRules, JudgedFlat(fit, r), r.verdict);
    r.usable = is_usable(r.verdict);
}

}  // namespace lensprof
