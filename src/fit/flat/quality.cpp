// The quality of a flat field result: residuals of the model, fine and coarse, for the frame and for each shot.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/covariance.h"
#include "fit/base/quantile.hpp"
#include "fit/flat/fit.hpp"
#include "fit/problem/loss.hpp"

namespace lensprof {
namespace {

constexpr int kSmooth = 2;             // coarse: means over 5 x 5 cells
constexpr double kSmoothed = 25.0;     // cells
constexpr double kTrimming = 1.06;     // variance of a robust mean of a few pixels, relative to that of the mean
constexpr double kGridNeeded = 0.003;  // of the light, rms

// Mean over the cells around each cell that have a value.
std::vector<double> smooth(const CellGrid &grid, const std::vector<double> &map) {
    std::vector<double> out(map.size(), std::numeric_limits<double>::quiet_NaN());
    for (int cell = 0; cell < grid.count(); cell++) {
        if (std::isnan(map[static_cast<size_t>(cell)])) continue;
        const int column = cell % grid.columns, row = cell / grid.columns;
        double sum = 0.0, count = 0.0;
        for (int y = std::max(0, row - kSmooth); y <= std::min(grid.rows - 1, row + kSmooth); y++)
            for (int x = std::max(0, column - kSmooth); x <= std::min(grid.columns - 1, column + kSmooth); x++) {
                double value = map[static_cast<size_t>(y * grid.columns + x)];
                if (!std::isnan(value)) sum += value, count += 1.0;
            }
        out[static_cast<size_t>(cell)] = sum / count;
    }
    return out;
}

struct Mean {
    double sum = 0.0, count = 0.0;
    void add(double value) { sum += value, count += 1.0; }
    double value() const { return count > 0.0 ? sum / count : 0.0; }
};

double root_of_rest(double square, double noise) { return std::sqrt(std::max(square - kTrimming * noise, 0.0)); }

struct Patterns {
    double texture, frame, per_shot;
};

// Splits the residuals, given the variance of a cell's noise (relative).
Patterns split_residuals(const FlatFit &fit, const lensprof_gain_grid *gain, double noise) {
    const int shots = fit.problem.model.shots;
    Mean fine, frame, per_shot;
    double depth = 0.0;
    for (int c = 0; c < fit.problem.model.channels; c++) {
        std::vector<std::vector<double>> coarse;
        std::vector<Mean> common(static_cast<size_t>(fit.grid.count()));
        for (int s = 0; s < shots; s++) {
            std::vector<double> map = residual_map(fit, s, c, gain, false);
            coarse.push_back(smooth(fit.grid, map));
            for (size_t i = 0; i < map.size(); i++)
                if (!std::isnan(map[i])) {
                    double rest = map[i] - coarse.back()[i];
                    fine.add(rest * rest);
                    common[i].add(coarse.back()[i]);
                }
        }
        for (size_t i = 0; i < common.size(); i++) {
            if (common[i].count == 0.0) continue;
            frame.add(common[i].value() * common[i].value());
            depth += 1.0 / common[i].count;
            for (const auto &map : coarse)
                if (common[i].count > 1.0 && !std::isnan(map[i]))
                    per_shot.add(std::pow(map[i] - common[i].value(), 2) * common[i].count / (common[i].count - 1.0));
        }
    }
    depth = frame.count > 0.0 ? depth / frame.count : 1.0;  // mean of 1 / number of shots that see a cell
    return {root_of_rest(fine.value() * kSmoothed / (kSmoothed - 1.0), noise),
            root_of_rest(frame.value(), noise * depth / kSmoothed), root_of_rest(per_shot.value(), noise / kSmoothed)};
}

double corner_sigma(const FlatFit &fit) {
    const auto &model = fit.problem.model;
    const double variance = lp_corner_variance(fit.covariance.data(), static_cast<uint32_t>(fit.covariance.rows()),
                                               static_cast<uint32_t>(model.k(0)), static_cast<uint32_t>(model.curves));
    return std::sqrt(std::max(variance, 0.0));
}

void describe_picture(const FlatFit &fit, const Shot &shot, uint32_t image, lensprof_flat_image_quality &q) {
    Mean white, black;
    std::vector<double> noise;
    uint32_t first[2] = {UINT32_MAX, UINT32_MAX}, last[2] = {0, 0};
    for (size_t i = 0; i < shot.card.size(); i++) {
        if (!shot.card[i]) continue;
        const Cell &cell = fit.pictures[image].cells[i];
        white.add(cell.state == CellState::white);
        black.add(cell.state == CellState::black);
        if (cell.state == CellState::used)
            for (size_t c = 0; c < fit.options.channels; c++)
                noise.push_back(255.0 * static_cast<double>(cell.noise[c]));
        const auto columns = static_cast<size_t>(fit.grid.columns);
        const uint32_t position[2] = {static_cast<uint32_t>(i % columns), static_cast<uint32_t>(i / columns)};
        for (int d = 0; d < 2; d++)
            first[d] = std::min(first[d], position[d]), last[d] = std::max(last[d], position[d] + 1);
    }
    q.white_share = white.value();
    q.black_share = black.value();
    q.noise_levels = median(noise);
    for (int d = 0; d < 2 && white.count > 0.0; d++) {
        double side = d == 0 ? fit.grid.cell_width() : fit.grid.cell_height();
        q.card[d] = static_cast<uint32_t>(std::lround(first[d] * side));
        q.card[2 + d] = static_cast<uint32_t>(std::lround(last[d] * side)) - q.card[d];
    }
}

double radius_of(const FlatFit &fit, const lensprof_vignetting &v, const FlatCell &cell) {
    return std::sqrt(lensprof_vignetting_r2(&v, fit.grid.width, fit.grid.height, cell.x, cell.y, nullptr));
}

void describe_images(const FlatFit &fit, FlatResult &r) {
    Responses responses(fit.options);
    for (size_t s = 0; s < fit.shots.size() && r.image_quality; s++) {
        const Shot &shot = fit.shots[s];
        lensprof_flat_image_quality q{};
        Mean square;
        for (const FlatCell &cell : fit.problem.cells) {
            if (cell.shot != static_cast<int>(s)) continue;
            q.cells++;
            q.radius = std::max(q.radius, radius_of(fit, r.vignetting[0], cell));
            for (int c = 0; c < fit.problem.model.channels; c++) {
                double p = flat_residual(fit.problem, fit.estimate, cell, c).prediction.value;
                square.add(std::pow(cell.value[static_cast<size_t>(c)] / p - 1.0, 2));
            }
        }
        q.residual = std::sqrt(square.value());
        auto gradient = light_gradient(fit.problem.model, fit.estimate.u, static_cast<int>(s));
        std::copy(gradient.begin(), gradient.end(), q.gradient);
        std::vector<double> ev_residuals = exposure_residuals(fit.options, fit.images, fit.pictures, responses, shot);
        for (size_t i = 0; i < shot.images.size(); i++) {
            q.ev_residual = ev_residuals[i];
            describe_picture(fit, shot, shot.images[i], q);
            r.image_quality[shot.images[i]] = q;
        }
    }
}

}  // namespace

std::vector<double> residual_map(const FlatFit &fit, int shot, int channel, const lensprof_gain_grid *gain, bool dust) {
    const Shot &shot_data = fit.shots[static_cast<size_t>(shot)];
    std::vector<double> map(shot_data.light.size(), std::numeric_limits<double>::quiet_NaN());
    for (size_t i = 0; i < map.size(); i++) {
        bool left_out = fit.left_out[static_cast<size_t>(shot)][i] && !dust;
        if (shot_data.light[i].state != CellState::used || !shot_data.card[i] || left_out) continue;
        const double x = shot_data.light[i].x, y = shot_data.light[i].y;
        double p = predict(fit.problem.model, fit.estimate.u, shot, channel, x, y).value;
        if (gain)
            p *= lensprof_gain_grid_eval(gain, fit.grid.width, fit.grid.height, x, y, static_cast<uint32_t>(channel));
        map[i] = shot_data.light[i].value[static_cast<size_t>(channel)] / p - 1.0;
    }
    return map;
}

void describe_flat(const FlatFit &fit, FlatResult &r) {
    Mean square, noise, inlier;
    r.radius = 0.0;
    for (const FlatCell &cell : fit.problem.cells) {
        r.radius = std::max(r.radius, radius_of(fit, r.vignetting[0], cell));
        inlier.add(flat_chi2(fit.problem, fit.estimate, cell) < inlier_limit(fit.problem.model.channels));
        for (int c = 0; c < fit.problem.model.channels; c++) {
            double p = flat_residual(fit.problem, fit.estimate, cell, c).prediction.value;
            square.add(std::pow(cell.value[static_cast<size_t>(c)] / p - 1.0, 2));
            noise.add(cell.variance[static_cast<size_t>(c)] / (p * p));
        }
    }
    r.residual = std::sqrt(square.value());
    r.noise = std::sqrt(noise.value());
    r.inlier_share = inlier.value();
    r.corner_sigma = corner_sigma(fit);
    Patterns rest = split_residuals(fit, nullptr, noise.value());
    r.texture = rest.texture;
    r.frame_residual = rest.frame;
    r.shot_residual = fit.shots.size() > 1 ? rest.per_shot : 0.0;
    r.grid_residual = 0.0;
    lensprof_gain_grid_init(&r.gain_grid);
    bool wanted = fit.options.grid == LENSPROF_FLAT_GRID_ALWAYS
                  || (fit.options.grid == LENSPROF_FLAT_GRID_AUTO && rest.frame > kGridNeeded);
    if (wanted && fit_gain_grid(fit, r.gain_grid)) {
        Patterns left = split_residuals(fit, &r.gain_grid, noise.value());
        r.grid_residual = left.frame;
        r.texture = left.texture;  // a steep residual contributes to it at the frame's border
        normalise_gain_grid(fit, r.gain_grid);
    }
    describe_images(fit, r);
}

}  // namespace lensprof
