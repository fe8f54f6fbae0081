// The quality of a flat field result: residuals of the model, fine and coarse, for the frame and for each shot.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/levels.h"
#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"
#include "fit/flat/fit.hpp"
#include "fit/problem/loss.hpp"

namespace lensprof {
namespace {

constexpr int kSmooth = 2;              // coarse: means over 5 x 5 cells
constexpr double kSmoothed = 25.0;      // cells
constexpr double kTrimming = 1.06;      // variance of a robust mean of a few pixels, relative to that of the mean
constexpr double kTextured = 1.25;      // variance of fine residuals, relative to the noise: what is less is its error
constexpr double kGridNeeded = 0.003;   // of the light, rms
constexpr double kAddedToGrid = 1e-3;   // the same if there is a grid anyway
constexpr double kDim = 0.1;            // of the light in the middle: a black cell is dark because of the falloff
constexpr double kMostContinued = 0.3;  // the same at most: what is black is not much brighter
constexpr double kContinued = 0.3;      // error of ln M beyond the data, relative to its change there

// What a cell has beyond the mean of those around it, of one side as many as of the other: a slope leaves nothing. NaN
// where a cell has no such neighbours. With the factor that makes its square that of independent cells.
std::vector<double> detail(const CellGrid &grid, const std::vector<double> &map) {
    std::vector<double> out(map.size(), std::numeric_limits<double>::quiet_NaN());
    for (int cell = 0; cell < grid.count(); cell++) {
        const int column = cell % grid.columns, row = cell / grid.columns;
        const int across = std::min({kSmooth, column, grid.columns - 1 - column});
        const int down = std::min({kSmooth, row, grid.rows - 1 - row});
        double sum = 0.0, count = 0.0;
        for (int y = -down; y <= down; y++)
            for (int x = -across; x <= across; x++) {
                const double value = map[static_cast<size_t>(cell + y * grid.columns + x)];
                const double opposite = map[static_cast<size_t>(cell - y * grid.columns - x)];
                if (!std::isnan(value) && !std::isnan(opposite)) sum += value, count += 1.0;
            }
        if (count > 1.0)
            out[static_cast<size_t>(cell)] =
                (map[static_cast<size_t>(cell)] - sum / count) * std::sqrt(count / (count - 1.0));
    }
    return out;
}

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
    size_t odd = 0;  // the shot whose coarse residual differs most from that of the others
};

// Mean square of the difference of one shot's coarse residuals from the median of the others, where these are several:
// a mean of few would follow the odd one.
class ShotDifferences {
public:
    explicit ShotDifferences(size_t shots) : squares_(shots) {}

    void add(const std::vector<std::vector<double>> &maps, size_t cell) {
        for (size_t s = 0; s < maps.size(); s++) {
            others_.clear();
            for (size_t other = 0; other < maps.size(); other++)
                if (other != s && !std::isnan(maps[other][cell])) others_.push_back(maps[other][cell]);
            if (!others_.empty() && !std::isnan(maps[s][cell]))
                squares_[s].add(std::pow(maps[s][cell] - 0.5 * (upper_median(others_) + median(others_)), 2));
        }
    }

    size_t largest() const {
        const auto less = [](const Mean &a, const Mean &b) { return a.value() < b.value(); };
        return static_cast<size_t>(std::max_element(squares_.begin(), squares_.end(), less) - squares_.begin());
    }

private:
    std::vector<Mean> squares_;
    std::vector<double> others_;
};

// Splits the residuals, given the variance of a cell's noise (relative).
Patterns split_residuals(const FlatFit &fit, const lensprof_gain_grid *gain, double noise) {
    const int shots = fit.problem.model.shots;
    Mean fine, frame, per_shot;
    ShotDifferences differences(static_cast<size_t>(shots));
    double depth = 0.0;
    for (int c = 0; c < fit.problem.model.channels; c++) {
        std::vector<std::vector<double>> coarse;
        std::vector<Mean> common(static_cast<size_t>(fit.grid.count()));
        for (int s = 0; s < shots; s++) {
            std::vector<double> map = residual_map(fit, s, c, gain, false);
            coarse.push_back(smooth(fit.grid, map));
            for (const double rest : detail(fit.grid, map))
                if (!std::isnan(rest)) fine.add(rest * rest);
            for (size_t i = 0; i < map.size(); i++)
                if (!std::isnan(map[i])) common[i].add(coarse.back()[i]);
        }
        for (size_t i = 0; i < common.size(); i++) {
            if (common[i].count == 0.0) continue;
            differences.add(coarse, i);
            frame.add(common[i].value() * common[i].value());
            depth += 1.0 / common[i].count;
            for (const auto &map : coarse)
                if (common[i].count > 1.0 && !std::isnan(map[i]))
                    per_shot.add(std::pow(map[i] - common[i].value(), 2) * common[i].count / (common[i].count - 1.0));
        }
    }
    depth = frame.count > 0.0 ? depth / frame.count : 1.0;  // mean of 1 / number of shots that see a cell
    return {fine.value() > kTextured * noise ? root_of_rest(fine.value(), noise) : 0.0,
            root_of_rest(frame.value(), noise * depth / kSmoothed), root_of_rest(per_shot.value(), noise / kSmoothed),
            differences.largest()};
}

constexpr double kNearCorner = 0.85;  // of the r^2 of the corner, from which on the pattern left counts as error there

// Mean square of the coarse residual near the corner, relative to the light, less that of noise. A pattern that a grid
// was not to carry is stated by itself.
double corner_misfit(const FlatFit &fit, const lensprof_gain_grid *gain) {
    const FlatModel &model = fit.problem.model;
    const lensprof_vignetting v = falloff_of(model, fit.estimate.u, 0);
    if (fit.options.grid == LENSPROF_FLAT_GRID_NONE) return 0.0;
    Mean square, noise;
    for (int s = 0; s < model.shots; s++)
        for (int c = 0; c < model.channels; c++) {
            const std::vector<double> map = smooth(fit.grid, residual_map(fit, s, c, gain, false));
            for (size_t i = 0; i < map.size(); i++) {
                const CellLight &light = fit.shots[static_cast<size_t>(s)].light[i];
                const double r2 =
                    lensprof_vignetting_r2(&v, fit.grid.width, fit.grid.height, light.x, light.y, nullptr);
                if (std::isnan(map[i]) || r2 < kNearCorner * std::min(corner_r2(model), model.reach)) continue;
                const auto channel = static_cast<size_t>(c);
                square.add(map[i] * map[i]);
                noise.add(light.variance[channel] / (light.value[channel] * light.value[channel]));
            }
        }
    return std::max(square.value() - kTrimming * noise.value() / kSmoothed, 0.0);
}

// Standard error of M where the corner is, of the curve with the largest one.
double corner_sigma(const FlatFit &fit) {
    const FlatModel &model = fit.problem.model;
    double largest = 0.0;
    for (int curve = 0; curve < model.curves && fit.covariance.size(); curve++) {
        const FalloffAt at = continued_falloff(model, fit.estimate.u, curve, corner_r2(model));
        const Eigen::Map<const Eigen::VectorXd> by_term(at.by_term.data(), model.terms());
        const Eigen::Index first = model.k(curve), n = model.terms();
        largest = std::max(largest, by_term.dot(fit.covariance.block(first, first, n, n) * by_term));
    }
    return std::sqrt(largest);
}

// Error of ln M in the corner from the light: curved along a line, it has as much of a curvature that is the same in
// all directions, which looks like falloff, as of one that is not. Mean over the shots and channels.
double curved_light(const FlatFit &fit) {
    const FlatModel &model = fit.problem.model;
    Mean curved;
    for (int s = 0; s < model.shots && model.light_terms == kMaxLightTerms; s++)
        for (int c = 0; c < model.channels; c++)
            curved.add(std::hypot(fit.estimate.u[model.light(s, c) + 2], fit.estimate.u[model.light(s, c) + 3]));
    return curved.value() * corner_r2(model);
}

// Error of ln M in the corner from what continues it beyond the data, and beyond the first cell that is black.
double continued_error(const FlatFit &fit) {
    const FlatModel &model = fit.problem.model;
    const lensprof_vignetting v = falloff_of(model, fit.estimate.u, 0);
    double seen = std::min(model.reach, corner_r2(model));
    for (int s = 0; s < model.shots; s++) {
        const Shot &shot = fit.shots[static_cast<size_t>(s)];
        const double dim = kDim * std::exp(fit.estimate.u[model.level(s, 0)]);  // not part of a dark border
        for (size_t i = 0; i < shot.light.size(); i++) {
            if (!shot.card[i] || shot.light[i].state != CellState::black || shot.light[i].value[0] > dim) continue;
            const auto [x, y] = fit.grid.middle(static_cast<int>(i));
            seen =
                std::min(seen, lensprof_vignetting_r2(&v, fit.grid.width, fit.grid.height, x - 0.5, y - 0.5, nullptr));
        }
    }
    const double end = continued_falloff(model, fit.estimate.u, 0, seen).value;
    const double change = std::log(continued_falloff(model, fit.estimate.u, 0, corner_r2(model)).value / end);
    return std::min(kContinued * std::abs(change), kMostContinued);
}

// The brightest grey value that counts: in each shot, mean over the channels and shots.
double brightest_grey(const FlatFit &fit) {
    Mean mean;
    for (const Shot &shot : fit.shots)
        for (size_t c = 0; c < fit.options.channels; c++) {
            double brightest = 0.0;
            for (const uint32_t i : shot.images)
                for (const Cell &cell : fit.pictures[i].cells)
                    if (cell.state == CellState::used)
                        brightest = std::max(brightest, static_cast<double>(cell.value[c]));
            mean.add(brightest);
        }
    return mean.value();
}

// The levels with the offset found, and what an error of them means in the corner.
void describe_levels(const FlatFit &fit, FlatResult &r) {
    const FlatOffset &offset = fit.offset;
    r.levels = fit.options.levels;
    double sigma = 0.0;  // share of white less black, as the light
    for (size_t c = 0; c < 3; c++) {
        const auto channel = static_cast<uint32_t>(c);
        const double span = lp_level_span(&fit.options.levels, channel), moved = span * offset.value[c];
        if (offset.value[c] != 0.0)
            r.levels.black[c] = lensprof_levels_to_sample(&fit.options.levels, channel, offset.value[c]);
        if (std::abs(moved) > std::abs(r.black_offset)) r.black_offset = moved;
        r.black_sigma = std::max(r.black_sigma, span * offset.sigma[c]);
        sigma = std::max(sigma, offset.sigma[c]);
    }
    r.black_shown = offset.is_shown;
    const double brightest = brightest_grey(fit);
    if (brightest > 0.0 && r.corner > 0.0)
        r.black_ev = sigma * std::abs(effect_of_offset(brightest, brightest * r.corner)) / std::log(2.0);
    r.sigma_without_black = r.corner_sigma;
    if (r.black_shown) r.corner_sigma = std::hypot(r.corner_sigma, r.corner * r.black_ev * std::log(2.0));
}

// M times grid where the corner is: mean of the channels over the directions in which it is in the frame.
double corner_of(const FlatFit &fit, const FlatResult &r) {
    const double w = fit.grid.width - 1.0, h = fit.grid.height - 1.0;
    const double half = lensprof_half_diagonal(fit.grid.width, fit.grid.height);
    const bool is_edge = fit.edge.radius > 0.0;
    Mean mean;
    for (int i = 0; i < (is_edge ? 64 : 4); i++) {
        const lensprof_vignetting &v = r.vignetting[0];
        const double angle = 2.0 * kPi * i / 64.0, radius = half * std::sqrt(corner_r2(fit.problem.model));
        const double x = is_edge ? 0.5 * w + half * v.center[0] + radius * std::cos(angle) : (i & 1) * w;
        const double y = is_edge ? 0.5 * h + half * v.center[1] + radius * std::sin(angle) : (i >> 1) * h;
        if (x < 0.0 || y < 0.0 || x > w || y > h) continue;
        for (int c = 0; c < fit.problem.model.channels; c++) {
            const auto channel = static_cast<uint32_t>(c);
            const double r2 = lensprof_vignetting_r2(&r.vignetting[c], fit.grid.width, fit.grid.height, x, y, nullptr);
            const double m = lensprof_vignetting_eval(&r.vignetting[c], r2, nullptr);
            mean.add(r.gain_grid.columns
                         ? m * lensprof_gain_grid_eval(&r.gain_grid, fit.grid.width, fit.grid.height, x, y, channel)
                         : m);
        }
    }
    return mean.value();
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
    const FlatLight light(fit.problem.model, fit.estimate.u);
    for (size_t s = 0; s < fit.shots.size() && r.image_quality; s++) {
        const Shot &shot = fit.shots[s];
        lensprof_flat_image_quality q{};
        Mean square;
        for (const FlatCell &cell : fit.problem.cells) {
            if (cell.shot != static_cast<int>(s)) continue;
            q.cells++;
            q.radius = std::max(q.radius, radius_of(fit, r.vignetting[0], cell));
            const auto predicted = light.at(cell.shot, cell.x, cell.y);
            for (size_t c = 0; c < fit.options.channels; c++)
                square.add(std::pow(cell.value[c] / predicted[c] - 1.0, 2));
        }
        q.residual = std::sqrt(square.value());
        auto gradient = light_gradient(fit.problem.model, fit.estimate.u, static_cast<int>(s));
        std::copy(gradient.begin(), gradient.end(), q.gradient);
        std::vector<double> ev_residuals =
            exposure_residuals(fit.options, fit.images.data(), fit.pictures, responses, shot);
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
    const FlatLight light(fit.problem.model, fit.estimate.u);
    for (size_t i = 0; i < map.size(); i++) {
        bool left_out = fit.left_out[static_cast<size_t>(shot)][i] && !dust;
        if (shot_data.light[i].state != CellState::used || !shot_data.card[i] || left_out) continue;
        const double x = shot_data.light[i].x, y = shot_data.light[i].y;
        double p = light.at(shot, x, y)[static_cast<size_t>(channel)];
        if (gain)
            p *= held_ratio(fit, channel, x, y)
                 * lensprof_gain_grid_eval(gain, fit.grid.width, fit.grid.height, x, y, static_cast<uint32_t>(channel));
        map[i] = shot_data.light[i].value[static_cast<size_t>(channel)] / p - 1.0;
    }
    return map;
}

// Mean variance of a cell's noise, relative to its light.
double noise_variance(const FlatFit &fit) {
    const FlatLight light(fit.problem.model, fit.estimate.u);
    Mean noise;
    for (const FlatCell &cell : fit.problem.cells) {
        const auto predicted = light.at(cell.shot, cell.x, cell.y);
        for (size_t c = 0; c < fit.options.channels; c++) noise.add(cell.variance[c] / (predicted[c] * predicted[c]));
    }
    return noise.value();
}

double frame_residual(const FlatFit &fit) { return split_residuals(fit, nullptr, noise_variance(fit)).frame; }

double shot_residual(const FlatFit &fit) { return split_residuals(fit, nullptr, noise_variance(fit)).per_shot; }

void describe_flat(const FlatFit &fit, FlatResult &r) {
    const FlatLight light(fit.problem.model, fit.estimate.u);
    Mean square, inlier;
    r.radius = 0.0;
    for (double chi2 : flat_chi2(fit.problem, fit.estimate))
        inlier.add(chi2 < inlier_limit(fit.problem.model.channels));
    for (const FlatCell &cell : fit.problem.cells) {
        r.radius = std::max(r.radius, radius_of(fit, r.vignetting[0], cell));
        const auto predicted = light.at(cell.shot, cell.x, cell.y);
        for (size_t c = 0; c < fit.options.channels; c++) square.add(std::pow(cell.value[c] / predicted[c] - 1.0, 2));
    }
    const double noise = noise_variance(fit);
    r.residual = std::sqrt(square.value());
    r.noise = std::sqrt(noise);
    r.inlier_share = inlier.value();
    r.corner_sigma = corner_sigma(fit);
    Patterns rest = split_residuals(fit, nullptr, noise);
    r.texture = rest.texture;
    r.frame_residual = rest.frame;
    r.shot_residual = fit.shots.size() > 1 ? rest.per_shot : 0.0;
    r.odd_shot = fit.shots[rest.odd].number;
    r.grid_residual = 0.0;
    lensprof_gain_grid_init(&r.gain_grid);
    const bool is_auto = fit.options.grid == LENSPROF_FLAT_GRID_AUTO;
    const double needed = fit.held.is_whole ? kGridNeeded : kAddedToGrid;
    const bool residual = fit.options.grid == LENSPROF_FLAT_GRID_ALWAYS || (is_auto && rest.frame > needed);
    if ((residual || (is_auto && !fit.held.is_whole)) && fit_gain_grid(fit, residual, r.gain_grid)) {
        Patterns left = split_residuals(fit, &r.gain_grid, noise);
        r.grid_residual = left.frame;
        r.texture = std::min(left.texture, rest.texture);  // a steep residual contributes to it at the frame's border
        normalise_gain_grid(fit, r.gain_grid);
    }
    r.corner = corner_of(fit, r);
    const double left = corner_misfit(fit, r.gain_grid.columns ? &r.gain_grid : nullptr);
    const double continued = fit.held.is_whole ? 0.0 : continued_error(fit);
    const double of_light = std::hypot(std::sqrt(left), continued, curved_light(fit));
    r.corner_sigma = std::hypot(r.corner_sigma, r.corner * of_light);
    describe_levels(fit, r);
    describe_images(fit, r);
}

}  // namespace lensprof
