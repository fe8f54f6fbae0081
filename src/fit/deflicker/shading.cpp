#include "fit/deflicker/shading.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "fit/base/quantile.hpp"
#include "fit/deflicker/chain.hpp"
#include "fit/deflicker/curve.hpp"

namespace lensprof {
namespace {

constexpr size_t kFewestInRow = 8;     // cells
constexpr double kRowWindow = 30.0;    // frames before and after one over which flicker of lines averages out
constexpr double kLargestRatio = 0.8;  // EV, of a cell beyond the ratio of the frames, by falloff or lines
constexpr double kWeakFalloff = 0.01;  // EV in the corner that is not corrected
constexpr double kOutlier = 4.0;       // median residuals

// Calls use(column, row, EV beyond the ratio) for every cell that both frames show.
template <class Use>
void for_each_residual(const FrameGrid &grid, const FrameCells &before, const FrameCells &after,
                       const FrameRatio &ratio, const Use &use) {
    const uint32_t main = main_channel(grid);
    for (uint32_t j = 0; j < grid.rows; j++)
        for (uint32_t i = 0; i < grid.columns; i++) {
            const float earlier = cell_at(grid, before.ev[main], i - ratio.shift[0], j - ratio.shift[1]);
            const float residual =
                after.ev[main][size_t(j) * grid.columns + i] - earlier - static_cast<float>(ratio.ev[main]);
            if (std::abs(residual) < static_cast<float>(kLargestRatio)) use(i, j, residual);
        }
}

// r^2 of a cell, in half diagonals of the frame.
double radius_2(const FrameGrid &grid, double column, double row) {
    const double x = grid.left + (column + 0.5) * (grid.right - grid.left) / grid.columns - grid.width / 2.0;
    const double y = grid.top + (row + 0.5) * (grid.bottom - grid.top) / grid.rows - grid.height / 2.0;
    const double half = std::hypot(double(grid.width), double(grid.height)) / 2.0;
    return (x * x + y * y) / (half * half);
}

}  // namespace

std::vector<float> row_ratios(const FrameGrid &grid, const FrameCells &before, const FrameCells &after,
                              const FrameRatio &ratio) {
    std::vector<std::vector<float>> values(grid.rows);
    for_each_residual(grid, before, after, ratio,
                      [&](uint32_t, uint32_t row, float residual) { values[row].push_back(residual); });
    std::vector<float> rows(grid.rows, 0.0f);
    for (size_t j = 0; j < rows.size(); j++)
        if (values[j].size() >= kFewestInRow) rows[j] = median(values[j]);
    return rows;
}

FrameCells without_rows(const FrameGrid &grid, FrameCells cells, const std::vector<float> &rows) {
    for (uint32_t c = 0; c < grid.channels; c++)
        for (size_t n = 0; n < grid.cells(); n++) {
            cells.ev[c][n] -= rows[n / grid.columns];
            cells.soft[c][n] -= rows[n / grid.columns];
        }
    return cells;
}

std::array<double, 2> falloff_ratio(const FrameGrid &grid, const FrameCells &before, const FrameCells &after,
                                    const FrameRatio &ratio) {
    std::vector<std::array<double, 2>> terms;  // r^2, EV
    for_each_residual(grid, before, after, ratio, [&](uint32_t column, uint32_t row, float residual) {
        terms.push_back({radius_2(grid, column, row), static_cast<double>(residual)});
    });
    Eigen::Vector3d q = Eigen::Vector3d::Zero();  // constant, r^2, r^4
    double limit = kLargestRatio;
    for (int round = 0; round < 6 && terms.size() >= kFewestInRow; round++) {
        Eigen::Matrix3d normal = Eigen::Matrix3d::Identity() * 1e-6;
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        std::vector<double> residuals;
        for (const auto &[r2, ev] : terms) {
            const Eigen::Vector3d term(1.0, r2, r2 * r2);
            const double residual = std::abs(ev - term.dot(q)), share = residual / limit;
            residuals.push_back(residual);
            if (share >= 1.0) continue;
            const double weight = (1.0 - share * share) * (1.0 - share * share);
            normal += weight * term * term.transpose();
            right += weight * ev * term;
        }
        q = normal.ldlt().solve(right);
        limit = std::max(kOutlier * median(residuals), 0.01);
    }
    return {q[1], q[2]};
}

FrameShadings::FrameShadings(const FrameChain &chain) : chain_(chain) {
    const auto &frames = chain.frames();
    std::map<double, size_t> count;
    for (const ChainFrame &frame : frames)
        if (std::isfinite(frame.f_number)) count[frame.f_number]++;
    size_t most = 0;
    for (const auto &[f_number, number] : count) most = std::max(most, number);
    std::map<double, Eigen::Index> place;
    Eigen::Index usual = 0;
    for (const auto &[f_number, number] : count) {
        if (number == most) usual = static_cast<Eigen::Index>(place.size());
        place.emplace(f_number, static_cast<Eigen::Index>(place.size()));
    }
    // Least squares of all steps; the usual aperture is 0.
    const auto size = static_cast<Eigen::Index>(place.size());
    Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(size, size) * 1e-3, right = Eigen::MatrixXd::Zero(size, 2);
    for (const FalloffStep &step : chain.falloff_steps()) {
        const Eigen::Index a = place.at(step.from), b = place.at(step.to);
        normal(a, a) += 1.0, normal(b, b) += 1.0, normal(a, b) -= 1.0, normal(b, a) -= 1.0;
        for (Eigen::Index n = 0; n < 2; n++)
            right(a, n) -= step.q[static_cast<size_t>(n)], right(b, n) += step.q[static_cast<size_t>(n)];
    }
    if (size > 0 && !chain.falloff_steps().empty()) {
        normal(usual, usual) += 1e6;
        const Eigen::MatrixXd q = normal.ldlt().solve(right);
        for (const auto &[f_number, n] : place) apertures_.push_back({f_number, {q(n, 0), q(n, 1)}});
    }
    // Lines: what exceeds the mean over neighbouring frames.
    rows_.resize(frames.size());
    const size_t bands = frames.empty() ? 0 : chain.grid().rows;
    for (size_t j = 0; j < bands; j++) {
        std::vector<double> times, values;
        std::vector<size_t> where;
        const auto finish = [&] {
            const bool is_long = times.size() >= 3;
            const std::vector<double> smooth =
                is_long ? smooth_curve(times, values, kRowWindow) : std::vector<double>(times.size());
            for (size_t n = 0; n < where.size() && is_long; n++) {
                rows_[where[n]].resize(bands, 0.0f);
                rows_[where[n]][j] = static_cast<float>(values[n] - smooth[n]);
            }
            times.clear(), values.clear(), where.clear();
        };
        uint32_t segment = 0;
        for (size_t i = 0; i < frames.size(); i++) {
            if (frames[i].rows.empty() || frames[i].state != LENSPROF_FRAME_LEVELLED) continue;
            if (frames[i].segment != segment) finish();
            segment = frames[i].segment;
            times.push_back(static_cast<double>(i)), values.push_back(static_cast<double>(frames[i].rows[j]));
            where.push_back(i);
        }
        finish();
    }
}

std::array<double, 2> FrameShadings::falloff_at(double f_number) const {
    for (const Aperture &aperture : apertures_)
        if (aperture.f_number == f_number && std::abs(aperture.q[0] + aperture.q[1]) > kWeakFalloff) return aperture.q;
    return {};
}

lensprof_gain_grid FrameShadings::of(size_t frame) const {
    lensprof_gain_grid grid;
    lensprof_gain_grid_init(&grid);
    const FrameGrid &cells = chain_.grid();
    const std::array<double, 2> q = falloff_at(chain_.frames()[frame].f_number);
    const std::vector<float> &rows = rows_[frame];
    const bool has_falloff = q[0] != 0.0 || q[1] != 0.0;
    if (rows.empty() && !has_falloff) return grid;
    grid.columns = has_falloff ? LENSPROF_GRID_SIDE : 2;
    grid.rows = LENSPROF_GRID_SIDE, grid.channels = 1;
    for (uint32_t j = 0; j < grid.rows; j++) {
        const double y = j * (cells.height - 1.0) / (grid.rows - 1.0);
        // The row of cells at this height, beyond the region that of its edge.
        const double row = (y + 0.5 - cells.top) * cells.rows / (cells.bottom - cells.top) - 0.5;
        const double within = std::clamp(row, 0.0, cells.rows - 1.0);
        const auto above = static_cast<size_t>(within), below = std::min(above + 1, size_t(cells.rows) - 1);
        const double part = within - static_cast<double>(above);
        const double line =
            rows.empty() ? 0.0
                         : (1.0 - part) * static_cast<double>(rows[above]) + part * static_cast<double>(rows[below]);
        for (uint32_t i = 0; i < grid.columns; i++) {
            const double x = i * (cells.width - 1.0) / (grid.columns - 1.0);
            const double dx = x - (cells.width - 1.0) / 2.0, dy = y - (cells.height - 1.0) / 2.0;
            const double half = std::hypot(double(cells.width), double(cells.height)) / 2.0;
            const double r2 = (dx * dx + dy * dy) / (half * half);
            grid.attenuation[j * grid.columns + i] = static_cast<float>(std::exp2(line + q[0] * r2 + q[1] * r2 * r2));
        }
    }
    return grid;
}

}  // namespace lensprof
