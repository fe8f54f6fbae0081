#include "fit/flat/fit.hpp"

#include <algorithm>
#include <cmath>

#include "core/covariance.h"
#include "falloff/dense.hpp"
#include "fit/base/parallel.hpp"

namespace lensprof {
namespace {

constexpr double kDiffers = 22.5;             // chi-squared of the curves' differences, 6 degrees of freedom: 99.9 %
constexpr double kSmallestDifference = 2e-3;  // of M in the corner: half a level

void report(const lensprof_flat_options &options, double done) {
    if (options.progress && options.progress(done, options.progress_user) != 0) throw Cancelled();
}

FlatModel make_model(const FlatFit &fit, int curves) {
    const auto &o = fit.options;
    FlatModel model;
    model.grid = fit.grid;
    model.channels = static_cast<int>(o.channels);
    model.curves = curves;
    model.shots = static_cast<int>(fit.shots.size());
    uint32_t light = o.light;
    if (light == LENSPROF_FLAT_LIGHT_AUTO) light = o.several ? LENSPROF_FLAT_LIGHT_EVEN : LENSPROF_FLAT_LIGHT_PLANE;
    model.light_terms = light == LENSPROF_FLAT_LIGHT_EVEN ? 0 : light == LENSPROF_FLAT_LIGHT_PLANE ? 2 : 4;
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

void solve(FlatFit &fit, int curves) {
    FlatProblem &problem = fit.problem;
    problem.model = make_model(fit, curves);
    problem.prior = make_flat_prior(fit.options, problem.model);
    problem.free = free_unknowns(problem.model, fit.options.free);
    fit.estimate = {};
    fit.estimate.u = flat_start(problem, fit.options.vignetting);
    solve_flat(problem, fit.estimate);
    fit.covariance = flat_covariance(problem, fit.estimate);
}

// Whether the channels' curves differ by more than their errors, and by enough to matter.
bool curves_differ(const FlatFit &fit) {
    if (fit.covariance.size() == 0) return false;
    const uint32_t flags[3] = {LENSPROF_FREE_K1, LENSPROF_FREE_K2, LENSPROF_FREE_K3};
    std::vector<int> powers;
    for (int i = 0; i < 3; i++)
        if (fit.options.free & flags[i]) powers.push_back(i);
    const auto n = static_cast<Eigen::Index>(2 * powers.size());
    Eigen::MatrixXd map = Eigen::MatrixXd::Zero(n, fit.covariance.rows());
    double corner[2] = {0.0, 0.0};
    for (Eigen::Index row = 0; row < n; row++) {
        int other = row % 2 == 0 ? 0 : 2, power = powers[static_cast<size_t>(row / 2)];
        map(row, fit.problem.model.k(other) + power) = 1.0;
        map(row, fit.problem.model.k(1) + power) = -1.0;
        corner[row % 2] += (map.row(row) * fit.estimate.u).value();
    }
    if (n == 0 || std::max(std::abs(corner[0]), std::abs(corner[1])) < kSmallestDifference) return false;
    Eigen::VectorXd difference = map * fit.estimate.u;
    Eigen::MatrixXd spread = map * fit.covariance * map.transpose();
    return difference.dot(solve_symmetric(spread, difference)) > kDiffers;
}

// Whether the pictures separate the light's gradient from the falloff's centre.
bool is_separated(const FlatFit &fit) {
    const FlatModel &model = fit.problem.model;
    if (!(fit.options.free & LENSPROF_FREE_CENTER)) return false;
    if (model.light_terms == 0) return true;
    return model.angles() > 1 && !model.own_light;
}

void fill_lens(const FlatFit &fit, FlatResult &r) {
    const FlatModel &model = fit.problem.model;
    r.vignettings = static_cast<uint32_t>(model.curves);
    for (int c = 0; c < 3; c++) r.vignetting[c] = falloff_of(model, fit.estimate.u, model.curves == 3 ? c : 0);
    r.light = model.light_terms == 0   ? LENSPROF_FLAT_LIGHT_EVEN
              : model.light_terms == 2 ? LENSPROF_FLAT_LIGHT_PLANE
                                       : LENSPROF_FLAT_LIGHT_QUADRATIC;
    r.shots = static_cast<uint32_t>(model.shots);
    r.cells = static_cast<uint32_t>(fit.problem.cells.size());
    r.separated = is_separated(fit);
    r.iterations = fit.estimate.iterations;
    r.converged = fit.estimate.converged;
    // The responses are held: zero rows.
    const uint32_t modes = fit.options.response ? lp_covariance_modes(fit.options.response, fit.options.responses) : 0;
    const auto lens = static_cast<uint32_t>(model.levels()), n = modes + lens;
    r.covariance_size = fit.covariance.size() && n <= LENSPROF_COVARIANCE_MAX ? n : 0;
    std::fill_n(r.covariance, LENSPROF_COVARIANCE_MAX * LENSPROF_COVARIANCE_MAX, 0.0);
    for (uint32_t i = 0; i < lens && r.covariance_size; i++)
        for (uint32_t j = 0; j < lens; j++) r.covariance[(modes + i) * n + modes + j] = fit.covariance(i, j);
}

void take_pictures(FlatFit &fit) {
    if (!measure_cells(fit.options, fit.images, fit.count, fit.grid, fit.pictures)) throw Cancelled();
    Responses responses(fit.options);
    fit.shots = group_shots(fit.images, fit.count);
    for (Shot &shot : fit.shots) {
        merge_exposures(fit.options, fit.images, fit.pictures, responses, shot);
        mark_card(fit.grid, fit.options.find_card != 0, static_cast<int>(fit.options.channels), shot);
    }
    fit.left_out.assign(fit.shots.size(), std::vector<bool>(static_cast<size_t>(fit.grid.count())));
}

}  // namespace

bool fit_flat(const lensprof_flat_options &options, const lensprof_flat_image *images, uint32_t count,
              FlatResult &result) {
    FlatFit fit{options, images, count, make_cell_grid(images, count), {}, {}, {}, {}, {}, {}};
    report(options, 0.0);
    take_pictures(fit);
    report(options, 0.8);
    collect_cells(fit);
    if (fit.problem.cells.empty()) return false;
    const int curves = options.channels == 3 && options.vignettings != 1 ? 3 : 1;
    solve(fit, curves);
    report(options, 0.85);
    find_spots(fit, result);
    if (result.spots) {
        collect_cells(fit);
        if (fit.problem.cells.empty()) return false;
        solve(fit, curves);
    }
    report(options, 0.9);
    if (options.vignettings == 0 && curves == 3 && !curves_differ(fit)) solve(fit, 1);
    report(options, 0.95);
    fill_lens(fit, result);
    describe_flat(fit, result);
    judge_flat(fit, result);
    return true;
}

}  // namespace lensprof
