#include "fit/flat/fit.hpp"

#include <algorithm>
#include <cmath>

#include "core/covariance.h"
#include "falloff/dense.hpp"
#include "fit/base/parallel.hpp"
#include "fit/flat/limits.hpp"

namespace lensprof {
namespace {

constexpr double kDiffers[] = {22.5,
                               32.9};  // chi-squared of the curves' differences, 6 and 12 degrees of freedom: 99.9 %
constexpr double kSmallestDifference = 2e-3;  // of M in the corner: half a level
constexpr double kMisfit = 1e-4;              // of the light: what k1..k3 leave that another form is tried for,
constexpr double kClearlyBetter = 50.0;       // and how much that must lower the objective: 10 sigma
constexpr double kEven = 22.5;                // chi-squared that six terms of a plane gain by chance: 99.9 %
constexpr double kFarFromEven = 1000.0;       // chi-squared: an even light is then no start for a plane
constexpr double kPlausibleCenter = 0.06;     // half diagonals, three standard deviations of the prior

void report(const lensprof_flat_options &options, double done) {
    if (options.progress && options.progress(done, options.progress_user) != 0) throw Cancelled();
}

FlatModel make_model(const FlatFit &fit, int curves, FalloffForm form) {
    const auto &o = fit.options;
    FlatModel model;
    model.grid = fit.grid;
    model.channels = static_cast<int>(o.channels);
    model.curves = curves;
    model.shots = static_cast<int>(fit.shots.size());
    model.form = form;
    model.light_terms = fit.light == LENSPROF_FLAT_LIGHT_EVEN ? 0 : fit.light == LENSPROF_FLAT_LIGHT_PLANE ? 2 : 4;
    model.own_light = o.own_light != 0;
    model.several = o.several != 0;
    for (const Shot &shot : fit.shots) model.turn.push_back({std::cos(shot.turn), std::sin(shot.turn)});
    return model;
}

void collect_cells(FlatFit &fit) {
    fit.problem.cells.clear();
    for (size_t s = 0; s < fit.shots.size(); s++)
        for (size_t cell = 0; cell < fit.shots[s].light.size(); cell++) {
            const CellLight &light = fit.shots[s].light[cell];
            if (light.state == CellState::used && fit.shots[s].card[cell] && !fit.left_out[s][cell])
                fit.problem.cells.push_back(
                    {static_cast<int>(s), static_cast<int>(cell), light.x, light.y, light.value, light.variance});
        }
}

void solve(FlatFit &fit, int curves, FalloffForm form) {
    FlatProblem &problem = fit.problem;
    problem.model = make_model(fit, curves, form);
    problem.prior = make_flat_prior(fit.options, problem.model);
    problem.free = free_unknowns(problem.model, fit.options.free);
    fit.estimate = {};
    fit.estimate.u = flat_start(problem, fit.options.vignetting);
    solve_flat(problem, fit.estimate, fit.steps);
    fit.covariance = flat_covariance(problem, fit.estimate);
}

FlatSolution solution_of(const FlatFit &fit) { return fit; }
void take(const FlatSolution &solution, FlatFit &fit) { static_cast<FlatSolution &>(fit) = solution; }

// Solves again, unless the steps do not suffice.
void solve_or_keep(FlatFit &fit, int curves, FalloffForm form) {
    if (fit.steps.are_over()) return;
    const FlatSolution before = solution_of(fit);
    solve(fit, curves, form);
    if (fit.steps.are_over()) take(before, fit);
}

// The objective of a solution for the noise that another one states.
double cost_with_noise_of(const FlatEstimate &noise, const FlatProblem &problem, FlatEstimate estimate) {
    estimate.unevenness = noise.unevenness, estimate.scale = noise.scale, estimate.inflation = noise.inflation;
    return flat_cost(problem, estimate);
}

// What the profile's k1..k3 do not hold needs a gain grid.
bool can_be_logarithm(const lensprof_flat_options &o) {
    constexpr uint32_t kAll = LENSPROF_FREE_K1 | LENSPROF_FREE_K2 | LENSPROF_FREE_K3;
    return o.grid != LENSPROF_FLAT_GRID_NONE && (o.free & kAll) == kAll;
}

// Solves again with ln M as the polynomial where M leaves a pattern, if that is clearly better. About a far centre, it
// would describe a lamp next to the card.
void choose_form(FlatFit &fit, int curves) {
    const bool is_open =
        can_be_logarithm(fit.options) && fit.problem.model.form == FalloffForm::powers && !fit.steps.are_over();
    if (!is_open || frame_residual(fit) < kMisfit) return;
    const FlatSolution powers = solution_of(fit);
    solve(fit, curves, FalloffForm::logarithm);
    const lensprof_vignetting v = falloff_of(fit.problem.model, fit.estimate.u, 0);
    const bool is_better = fit.covariance.size() && fit.estimate.converged
                           && std::hypot(v.center[0], v.center[1]) < flat_limits::kFarCenter
                           && flat_cost(fit.problem, fit.estimate) + kClearlyBetter
                                  < cost_with_noise_of(fit.estimate, powers.problem, powers.estimate);
    if (!is_better) take(powers, fit);
}

// The plane again, from the solution of an even light. Far from the solution, the pattern that a wrong centre leaves
// inflates the errors, and with them the weight of the prior that keeps the centre wrong.
void try_from_even(const FlatSolution &even, FlatSolution &plane, FlatSteps &steps) {
    FlatEstimate estimate = plane.estimate;
    estimate.u.setZero();
    estimate.u.head(even.estimate.u.size()) = even.estimate.u;
    refine_flat(plane.problem, estimate, steps);
    if (flat_cost(plane.problem, estimate) >= cost_with_noise_of(estimate, plane.problem, plane.estimate)) return;
    plane.estimate = estimate;
    plane.covariance = flat_covariance(plane.problem, estimate);
}

// Largest change of the falloff from the middle of the frame to a corner between two solutions, EV.
double corner_difference(const CellGrid &grid, const FlatSolution &one, const FlatSolution &other) {
    const double w = grid.width - 1.0, h = grid.height - 1.0;
    const auto falloff = [&](const FlatSolution &solution, double x, double y) {
        const FlatModel &model = solution.problem.model;
        const lensprof_vignetting v = falloff_of(model, solution.estimate.u, 0);
        const double r2 = lensprof_vignetting_r2(&v, grid.width, grid.height, x, y, nullptr);
        return falloff_at(model, solution.estimate.u, model.curves / 2, std::min(r2, data_reach(grid, solution))).value;
    };
    double largest = 0.0;
    for (int i = 0; i < 4; i++) {
        const double x = (i & 1) * w, y = (i >> 1) * h;
        const double ratio = falloff(one, x, y) / falloff(other, x, y) * falloff(other, 0.5 * w, 0.5 * h)
                             / falloff(one, 0.5 * w, 0.5 * h);
        largest = std::max(largest, std::abs(std::log2(ratio)));
    }
    return largest;
}

// To first order, a light with a gradient and an off-centre falloff make the same picture. Of shots at one angle, the
// light is taken as even if a centre that lenses have describes them as well as a plane does. What k1..k3 cannot hold
// must not decide that: the two are compared with ln M as the polynomial, if it may be.
void choose_light(FlatFit &fit, int curves) {
    const auto &o = fit.options;
    const bool is_open = o.light == LENSPROF_FLAT_LIGHT_AUTO && !o.several && (o.free & LENSPROF_FREE_CENTER)
                         && fit.problem.model.angles() == 1;
    if (!is_open || fit.steps.are_over()) return;
    const FlatSolution before = solution_of(fit);
    const FalloffForm form = can_be_logarithm(o) ? FalloffForm::logarithm : FalloffForm::powers;
    if (before.problem.model.form != form) solve(fit, curves, form);
    FlatSolution plane = solution_of(fit);
    fit.light = LENSPROF_FLAT_LIGHT_EVEN;
    solve(fit, curves, form);
    const FlatSolution even = solution_of(fit);
    const auto gain_of_plane = [&] {
        const double cost_even = cost_with_noise_of(plane.estimate, even.problem, even.estimate);
        return 2.0 * (cost_even - flat_cost(plane.problem, plane.estimate));
    };
    if (gain_of_plane() < kFarFromEven) try_from_even(even, plane, fit.steps);
    const double gain = gain_of_plane();
    const lensprof_vignetting v = falloff_of(even.problem.model, even.estimate.u, 0);
    fit.light_ev = corner_difference(fit.grid, even, plane);
    const bool is_even = gain < kEven && std::hypot(v.center[0], v.center[1]) < kPlausibleCenter;
    fit.other = is_even ? plane : even;
    if (!is_even) fit.light = LENSPROF_FLAT_LIGHT_PLANE;
    if (before.problem.model.form == form)
        take(is_even ? even : plane, fit);
    else if (is_even)
        solve(fit, curves, before.problem.model.form);
    else
        take(before, fit);
    if (!fit.steps.are_over()) return;
    fit.light = LENSPROF_FLAT_LIGHT_PLANE, fit.light_ev = 0.0;  // what was cut off does not count
    fit.other.reset();
    take(before, fit);
}

// Shots at several angles separate the light from the lens in its second-order terms, too.
void choose_curvature(FlatFit &fit, int curves) {
    const FlatModel &model = fit.problem.model;
    const bool is_open = fit.options.light == LENSPROF_FLAT_LIGHT_AUTO && model.light_terms == 2 && model.angles() > 1
                         && !model.own_light;
    if (!is_open || !fit.estimate.converged || fit.steps.are_over()) return;
    const FlatSolution plane = solution_of(fit);
    fit.light = LENSPROF_FLAT_LIGHT_QUADRATIC;
    solve(fit, curves, plane.problem.model.form);
    const bool is_better = fit.covariance.size() && fit.estimate.converged
                           && flat_cost(fit.problem, fit.estimate) + kClearlyBetter
                                  < cost_with_noise_of(fit.estimate, plane.problem, plane.estimate);
    if (is_better) return;
    fit.light = LENSPROF_FLAT_LIGHT_PLANE;
    take(plane, fit);
}

// M in the middle of a cell over its mean in the cell, by Gauss's rule with two places per direction.
double middle_over_mean(const FlatFit &fit, int curve, const CellLight &light) {
    const CellGrid &grid = fit.grid;
    const lensprof_vignetting v = falloff_of(fit.problem.model, fit.estimate.u, curve);
    const auto falloff = [&](double x, double y) {
        const double r2 = lensprof_vignetting_r2(&v, grid.width, grid.height, x, y, nullptr);
        return falloff_at(fit.problem.model, fit.estimate.u, curve, r2).value;
    };
    const double dx = grid.cell_width() / std::sqrt(12.0), dy = grid.cell_height() / std::sqrt(12.0);
    const double middle = falloff(light.x, light.y);
    double mean = 0.0;
    for (const double x : {light.x - dx, light.x + dx})
        for (const double y : {light.y - dy, light.y + dy}) mean += 0.25 * falloff(x, y);
    return middle > 0.0 && mean > 0.0 ? middle / mean : 1.0;
}

// The light of a cell is the mean of its pixels. Where M is curved, that is not the one in its middle, with which the
// model is compared: with the falloff found, replaces the mean by it, and solves again.
void take_middles(FlatFit &fit) {
    const FlatModel &model = fit.problem.model;
    if (!fit.estimate.converged || fit.steps.are_over()) return;
    for (Shot &shot : fit.shots)
        for (CellLight &light : shot.light)
            for (int c = 0; c < model.channels && light.state == CellState::used; c++)
                light.value[static_cast<size_t>(c)] *= middle_over_mean(fit, model.curve_of(c), light);
    collect_cells(fit);
    refine_flat(fit.problem, fit.estimate, fit.steps);
    fit.covariance = flat_covariance(fit.problem, fit.estimate);
}

// Whether the channels' curves differ by more than their errors, and by enough to matter.
bool curves_differ(const FlatFit &fit) {
    const FlatModel &model = fit.problem.model;
    if (fit.covariance.size() == 0) return false;
    const uint32_t flags[3] = {LENSPROF_FREE_K1, LENSPROF_FREE_K2, LENSPROF_FREE_K3};
    const bool is_log = model.form == FalloffForm::logarithm;
    std::vector<int> powers;
    for (int i = 0; i < model.terms(); i++)
        if (is_log || (fit.options.free & flags[i])) powers.push_back(i);
    const auto n = static_cast<Eigen::Index>(2 * powers.size());
    Eigen::MatrixXd map = Eigen::MatrixXd::Zero(n, fit.covariance.rows());
    const auto corner = [&](int curve) { return falloff_at(model, fit.estimate.u, curve, 1.0).value; };
    for (Eigen::Index row = 0; row < n; row++) {
        int other = row % 2 == 0 ? 0 : 2, power = powers[static_cast<size_t>(row / 2)];
        map(row, model.k(other) + power) = 1.0;
        map(row, model.k(1) + power) = -1.0;
    }
    const double largest = std::max(std::abs(corner(0) - corner(1)), std::abs(corner(2) - corner(1)));
    if (n == 0 || largest < kSmallestDifference) return false;
    Eigen::VectorXd difference = map * fit.estimate.u;
    Eigen::MatrixXd spread = map * fit.covariance * map.transpose();
    return difference.dot(solve_symmetric(spread, difference)) > kDiffers[is_log];
}

// Whether the pictures separate the light's gradient from the falloff's centre.
bool is_separated(const FlatFit &fit) {
    const FlatModel &model = fit.problem.model;
    if (!(fit.options.free & LENSPROF_FREE_CENTER)) return false;
    if (fit.other) return false;
    if (model.light_terms == 0) return true;
    return model.angles() > 1 && !model.own_light;
}

void fill_lens(const FlatFit &fit, FlatResult &r) {
    const FlatModel &model = fit.problem.model;
    r.vignettings = static_cast<uint32_t>(model.curves);
    for (size_t c = 0; c < 3; c++) r.vignetting[c] = fit.held.curve[model.curves == 3 ? c : 0];
    r.polynomial_error = fit.held.left;
    r.light = fit.light;
    r.light_ev = fit.light_ev;
    r.edge_radius = fit.edge.radius;
    r.edge_share = fit.edge.share;
    r.image_circle = fit.edge.circle.value_or(lensprof_image_circle{});
    if (fit.edge.circle)  // the falloff does not describe a soft edge
        r.image_circle.radius = std::max(r.image_circle.radius - fit.edge.soft, 0.01);
    r.shots = static_cast<uint32_t>(model.shots);
    r.cells = static_cast<uint32_t>(fit.problem.cells.size());
    r.separated = is_separated(fit);
    r.iterations = fit.estimate.iterations;
    r.converged = fit.estimate.converged;
    // The responses are held: zero rows.
    const uint32_t modes = fit.options.response ? lp_covariance_modes(fit.options.response, fit.options.responses) : 0;
    const auto lens = static_cast<uint32_t>(3 * model.curves + 2), n = modes + lens;
    r.covariance_size = fit.held.covariance.size() && n <= LENSPROF_COVARIANCE_MAX ? n : 0;
    std::fill_n(r.covariance, LENSPROF_COVARIANCE_MAX * LENSPROF_COVARIANCE_MAX, 0.0);
    for (uint32_t i = 0; i < lens && r.covariance_size; i++)
        for (uint32_t j = 0; j < lens; j++) r.covariance[(modes + i) * n + modes + j] = fit.held.covariance(i, j);
}

// What lies beyond the end of the image circle is not the card.
void leave_out_surround(FlatFit &fit) {
    for (Shot &shot : fit.shots) {
        const FlatEdge edge = find_edge(fit.grid, static_cast<int>(fit.options.channels), shot);
        if (edge.radius == 0.0) continue;
        for (size_t i = 0; i < shot.card.size(); i++) shot.card[i] = shot.card[i] && !edge.outside[i];
        const bool has_circle = edge.circle.has_value();  // of a shot that shows it
        if (has_circle == fit.edge.circle.has_value() ? edge.share > fit.edge.share : has_circle) fit.edge = edge;
    }
}

void take_pictures(FlatFit &fit) {
    if (!measure_cells(fit.options, fit.images.data(), fit.count, fit.grid, fit.pictures)) throw Cancelled();
    Responses responses(fit.options);
    fit.shots = group_shots(fit.images.data(), fit.count);
    subtract_offset(fit);
    for (Shot &shot : fit.shots) {
        merge_exposures(fit.options, fit.images.data(), fit.pictures, responses, shot);
        mark_card(fit.grid, fit.options.find_card != 0, static_cast<int>(fit.options.channels), shot);
    }
    if (!fit.options.find_card && !fit.options.several) leave_out_surround(fit);
    fit.left_out.assign(fit.shots.size(), std::vector<bool>(static_cast<size_t>(fit.grid.count())));
}

// Whether shots at one angle differ by more than is accepted: no form and no light that they have in common changes
// that.
bool contradict_each_other(const FlatFit &fit) {
    return fit.shots.size() > 1 && fit.problem.model.angles() == 1 && shot_residual(fit) > flat_limits::kMuchPerShot;
}

// Falloff and light, with the cells of dust left out; false if no cell is left.
bool solve_all(FlatFit &fit, FlatResult &result) {
    const auto &o = fit.options;
    collect_cells(fit);
    if (fit.problem.cells.empty()) return false;
    const int curves = o.channels == 3 && o.vignettings != 1 ? 3 : 1;
    solve(fit, curves, FalloffForm::powers);
    choose_form(fit, curves);
    if (contradict_each_other(fit)) fit.steps.left = 0;  // they are refused: no step is spent on choices
    report(o, 0.85);
    find_spots(fit, result);
    if (result.spots) {
        collect_cells(fit);
        if (fit.problem.cells.empty()) return false;
        solve_or_keep(fit, curves, fit.problem.model.form);
    }
    report(o, 0.9);
    choose_light(fit, curves);
    choose_curvature(fit, curves);
    choose_form(fit, curves);
    if (o.vignettings == 0 && curves == 3 && !curves_differ(fit)) solve_or_keep(fit, 1, fit.problem.model.form);
    take_middles(fit);
    report(o, 0.95);
    return true;
}

}  // namespace

bool fit_flat(const lensprof_flat_options &options, const lensprof_flat_image *images, uint32_t count,
              FlatResult &result) {
    FlatFit fit{{}, options, {images, images + count}, count, make_cell_grid(images, count)};
    fit.light = options.several ? LENSPROF_FLAT_LIGHT_EVEN : LENSPROF_FLAT_LIGHT_PLANE;
    if (options.light != LENSPROF_FLAT_LIGHT_AUTO) fit.light = options.light;
    report(options, 0.0);
    take_pictures(fit);
    report(options, 0.8);
    if (!solve_all(fit, result)) return false;
    hold_falloff(fit);
    fill_lens(fit, result);
    describe_flat(fit, result);
    judge_flat(fit, result);
    return true;
}

}  // namespace lensprof
