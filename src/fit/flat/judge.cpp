// The verdict on a flat field: why it is not usable, or what to mind about it, in plain words.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fit/base/quantile.hpp"
#include "fit/flat/fit.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kFewestCells = 60;
constexpr double kSmallestRadius = 0.6, kWholeRadius = 0.9;  // half diagonals
constexpr double kMuchBeyond = 0.2, kSomeBeyond = 0.005;     // of the card, white or black in every exposure
constexpr double kLargestCornerSigma = 0.01;                 // of M
constexpr double kMuchTexture = 0.01, kSomeTexture = 0.005;  // of the light
constexpr double kSteepAlone = 0.2, kSlantAlone = 0.1;       // of the light a half diagonal, not turned:
constexpr double kSteepTurned = 0.5;                         // its square is about what a plane leaves out
constexpr double kMuchOwn = 0.015, kSomeOwn = 0.004;         // of the light
constexpr double kNotRadial = 0.003;                         // of the light
constexpr double kWrongEv = 0.3, kDoubtfulEv = 0.1;          // EV, within a shot
constexpr double kSteepest = 0.05, kFlattest = 20.0;         // d ln E / d ln B; of cameras .2 to 10
constexpr double kFewInliers = 0.5;
constexpr double kFarCentre = 0.1;  // half diagonals, as for the overlap fit

template <class... Values>
bool say(lensprof_flat_result &r, bool usable, const char *reason, Values... values) {
    r.usable = usable;
    std::snprintf(r.reason, sizeof r.reason, reason, values...);
    return true;
}

// The worst of the shots in some respect.
struct Worst {
    double value = 0.0;
    uint32_t shot = 0;

    void take(double other, uint32_t number) {
        if (other > value) value = other, shot = number;
    }
};

// Share of a shot's card that is white (or black) in every exposure.
Worst beyond(const FlatFit &fit, CellState state) {
    Worst worst;
    for (const Shot &shot : fit.shots) {
        double card = 0.0, lost = 0.0;
        for (size_t i = 0; i < shot.card.size(); i++)
            if (shot.card[i]) card += 1.0, lost += shot.light[i].state == state;
        if (card > 0.0) worst.take(lost / card, shot.number);
    }
    return worst;
}

// The shot without a card in it; false when all have one.
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

// The picture farthest from the others of its shot, by its index.
Worst wrong_exposure(const FlatFit &fit, const lensprof_flat_result &r) {
    Worst worst;
    for (uint32_t i = 0; i < fit.count && r.image_quality; i++) worst.take(std::abs(r.image_quality[i].ev_residual), i);
    return worst;
}

// By how much a picture's light changes with its grey values, d ln E / d ln B: median over cells and channels.
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

// The response says next to nothing about light where the picture's grey values lie.
bool has_no_gradation(const FlatFit &fit, lensprof_flat_result &r) {
    for (uint32_t i = 0; i < fit.count; i++) {
        double contrast = contrast_of_light(fit, i);
        if (contrast < kSteepest || contrast > kFlattest)
            return say(r, false,
                       "the response given is %s where the grey values of image %u lie, so that these do not tell the "
                       "light; give the camera's own response, or another exposure",
                       contrast < kSteepest ? "a step" : "flat", i);
    }
    return false;
}

bool lacks_light(const FlatFit &fit, lensprof_flat_result &r) {
    Worst white = beyond(fit, CellState::white), black = beyond(fit, CellState::black);
    if (white.value > kMuchBeyond)
        return say(r, false, "%.0f %% of the card in shot %u is white in every exposure; take a shorter exposure",
                   100.0 * white.value, white.shot);
    if (black.value > kMuchBeyond)
        return say(r, false, "%.0f %% of the card in shot %u is black in every exposure; take a longer exposure",
                   100.0 * black.value, black.shot);
    uint32_t number;
    if (lacks_card(fit, number))
        return say(r, false,
                   "no card was found in shot %u: no even bright region is larger than a hundredth of the frame; "
                   "say where it is, or use an even light over the whole frame",
                   number);
    if (r.cells < kFewestCells)
        return say(r, false, "%u cells of even light are too few; use larger pictures, or more of the card", r.cells);
    if (r.radius < kSmallestRadius)
        return say(r, false,
                   "the card reaches to %.2f of the half diagonal only, which does not show the falloff in the "
                   "corners; add pictures with the card in the corners",
                   r.radius);
    return false;
}

bool contradicts_model(const FlatFit &fit, lensprof_flat_result &r) {
    Worst wrong = wrong_exposure(fit, r), steep = steepest(fit);
    if (wrong.value > kWrongEv)
        return say(r, false,
                   "image %u is %.2f EV away from the others of its shot: the exposures, or the response, are not "
                   "what was said, or the light changed",
                   wrong.shot, wrong.value);
    if (r.texture > kMuchTexture)
        return say(r, false,
                   "the card is not even: it has texture of %.1f %% beyond the noise; defocus, come closer, or use a "
                   "diffuser",
                   100.0 * r.texture);
    if (r.shot_residual > kMuchOwn)
        return say(r, false,
                   "the shots differ by %.1f %% in ways that one lens and one light do not explain: the light changed, "
                   "a shadow fell on the card, or the angles of the turned shots are wrong",
                   100.0 * r.shot_residual);
    if (r.inlier_share < kFewInliers)
        return say(r, false, "only %.0f %% of the cells agree with one falloff and one light; is it an even light?",
                   100.0 * r.inlier_share);
    const bool plane = fit.problem.model.light_terms > 0;
    if (plane && steep.value > (r.separated ? kSteepTurned : kSteepAlone))
        return say(r, false,
                   r.separated
                       ? "the light of shot %u changes by %.0f %% a half diagonal, which a plane does not "
                         "describe; even it out"
                       : "the light of shot %u changes by %.0f %% a half diagonal, and no turned shot tells it "
                         "from the lens; even it out, or add a shot with the camera turned by 90 or 180 degrees",
                   steep.shot, 100.0 * steep.value);
    return false;
}

bool is_undetermined(const FlatFit &fit, lensprof_flat_result &r) {
    if (!r.converged) return say(r, false, "the fit did not settle in %u iterations", r.iterations);
    if (fit.covariance.size() == 0)
        return say(r, false,
                   "the pictures do not determine all parameters: hold the centre, take the light as even, or add a "
                   "shot with the camera turned");
    // What is not radial makes the polynomial uncertain, but not what polynomial and grid are together.
    const bool radial = r.frame_residual < kNotRadial;
    if (r.corner_sigma > kLargestCornerSigma && !radial && !r.gain_grid.columns)
        return say(
            r, false,
            "%.1f %% of the light is not radial, which leaves the falloff in the corners uncertain by %.1f %%; ask "
            "for a gain grid",
            100.0 * r.frame_residual, 100.0 * r.corner_sigma);
    if (r.corner_sigma > kLargestCornerSigma && radial)
        return say(r, false,
                   "the falloff in the corners is uncertain by %.1f %%: too noisy, or the card is not seen there; "
                   "average more pictures, or add some with the card in the corners",
                   100.0 * r.corner_sigma);
    return false;
}

// What the result says beside being usable, the weightiest alone.
void mind(const FlatFit &fit, lensprof_flat_result &r) {
    Worst wrong = wrong_exposure(fit, r), steep = steepest(fit), white = beyond(fit, CellState::white),
          black = beyond(fit, CellState::black);
    const auto &centre = r.vignetting[0].center;
    const bool plane = fit.problem.model.light_terms > 0;
    if (r.radius < kWholeRadius)
        say(r, true, "the card reaches to %.2f of the half diagonal: what is said of the corners is extrapolated",
            r.radius);
    else if (std::max(white.value, black.value) > kSomeBeyond)
        say(r, true, "%.1f %% of the card in shot %u is %s in every exposure and was left out",
            100.0 * std::max(white.value, black.value), white.value > black.value ? white.shot : black.shot,
            white.value > black.value ? "white" : "black");
    else if (wrong.value > kDoubtfulEv)
        say(r, true,
            "image %u is %.2f EV away from the others of its shot: exposures or response are not quite what was said",
            wrong.shot, wrong.value);
    else if (r.shot_residual > kSomeOwn)
        say(r, true, "the shots differ by %.1f %% in ways that one lens and one light do not explain",
            100.0 * r.shot_residual);
    else if (r.texture > kSomeTexture)
        say(r, true, "the card has texture of %.1f %% beyond the noise; defocus or use a diffuser", 100.0 * r.texture);
    else if (plane && !r.separated && (fit.options.free & LENSPROF_FREE_CENTER) && steep.value > kSlantAlone)
        say(r, true,
            "the light changes by %.0f %% a half diagonal and no turned shot tells it from the lens: the centre rests "
            "on its prior; add a shot with the camera turned by 90 or 180 degrees",
            100.0 * steep.value);
    else if (r.frame_residual > kNotRadial)
        say(r, true,
            r.gain_grid.columns ? "%.1f %% of the light is not radial: the gain grid takes it, and leaves %.1f %%"
                                : "%.1f %% of the light is not radial; ask for a gain grid",
            100.0 * r.frame_residual, 100.0 * r.grid_residual);
    else if (std::hypot(centre[0], centre[1]) > kFarCentre)
        say(r, true,
            "the centre of the falloff lies %.2f half diagonals from the middle of the frame: are the "
            "pictures cropped, or is the light not even?",
            std::hypot(centre[0], centre[1]));
    else if (plane && !r.separated && (fit.options.free & LENSPROF_FREE_CENTER))
        say(r, true, "no turned shot tells the light's gradient from the lens: the centre rests on its prior");
    else if (r.spots)
        say(r, true, "%u spots of dust were left out", r.spots);
}

}  // namespace

void judge_flat(const FlatFit &fit, lensprof_flat_result &r) {
    if (lacks_light(fit, r) || has_no_gradation(fit, r) || contradicts_model(fit, r) || is_undetermined(fit, r)) return;
    r.usable = 1;
    r.reason[0] = 0;
    mind(fit, r);
}

}  // namespace lensprof
