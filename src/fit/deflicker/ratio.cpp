#include "fit/deflicker/ratio.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fit/base/location.hpp"
#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

constexpr double kToneTolerance = 0.12;  // share of the ratio by which tones may differ, if the response is wrong
constexpr double kSameScene = 0.95;      // correlation of the cells of frames of one scene
constexpr double kSmallestAgreeing = 0.15, kSmallestCommon = 0.04;  // shares of a ratio that is trusted
constexpr double kNarrowest = 0.002;                                // EV, spread of the cells
constexpr double kDim = 0.02;                                       // irradiance below which noise outweighs texture
constexpr double kCellsPerError = 16.0;  // neighbouring cells err alike: this many count as one
constexpr double kWorthwhile = 0.85;     // spread with a shift, relative to that without, that justifies it
constexpr double kSmallestShift = 0.01;  // cells
constexpr int kSearchSteps = 12;

// The difference of every cell that both frames show.
struct Differences {
    std::vector<float> ev[3];
    std::vector<float> weight;
    double correlation = 0.0;  // of both frames' logarithms
};

// Correlation of pairs of numbers.
struct Correlation {
    double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;

    void add(double x, double y) { n += 1, a += x, b += y, aa += x * x, bb += y * y, ab += x * y; }
    double value() const {
        const double variance = (aa - a * a / n) * (bb - b * b / n);
        return n > 2 && variance > 0.0 ? (ab - a * b / n) / std::sqrt(variance) : 0.0;
    }
};

Differences differences_of(const FrameGrid &grid, const FrameCells &before, const FrameCells &after,
                           const std::vector<float> &steadiness, const CellShift &shift) {
    Differences d;
    const bool is_still = shift[0] == 0.0 && shift[1] == 0.0;
    const uint32_t main = main_channel(grid);
    Correlation correlation;
    for (uint32_t j = 0; j < grid.rows; j++)
        for (uint32_t i = 0; i < grid.columns; i++) {
            const size_t n = size_t(j) * grid.columns + i;
            float ev[3];
            bool is_common = true;
            for (uint32_t c = 0; c < grid.channels && is_common; c++) {
                ev[c] = is_still ? after.ev[c][n] - before.ev[c][n]
                                 : after.soft[c][n] - cell_at(grid, before.soft[c], i - shift[0], j - shift[1]);
                is_common = std::isfinite(ev[c]);
            }
            if (!is_common) continue;
            const auto later = static_cast<double>(after.ev[main][n]);
            correlation.add(later - static_cast<double>(ev[main]), later);
            for (uint32_t c = 0; c < grid.channels; c++) d.ev[c].push_back(ev[c]);
            const double darker = std::exp2(static_cast<double>(after.ev[main][n]) - std::max(0.0f, ev[main]));
            const double steady = is_still && !steadiness.empty() ? static_cast<double>(steadiness[n]) : 1.0;
            d.weight.push_back(static_cast<float>(steady * darker / (darker + kDim)));
        }
    d.correlation = correlation.value();
    return d;
}

FrameRatio ratio_of(const FrameGrid &grid, const Differences &d, const CellShift &shift) {
    FrameRatio ratio;
    ratio.shift = shift;
    const size_t count = d.weight.size();
    ratio.common = static_cast<double>(count) / static_cast<double>(grid.cells());
    if (count < kFewestCells) return ratio;
    const uint32_t main = main_channel(grid);
    const Location level = locate(d.ev[main], d.weight, kNarrowest);
    ratio.ev.fill(level.middle);
    ratio.spread = level.spread;
    // With a wrong response, dark and bright cells of one scene have different ratios.
    const double tolerance = d.correlation > kSameScene ? kToneTolerance : 0.0;
    const double limit = kAgreement + tolerance * std::abs(level.middle);
    size_t agreeing = 0;
    std::vector<float> weight = d.weight;
    for (size_t n = 0; n < count; n++) {
        const double residual = std::abs(static_cast<double>(d.ev[main][n]) - level.middle);
        agreeing += residual < limit;
        if (residual > kTukey * level.spread) weight[n] = 0.0f;
    }
    ratio.agreeing = static_cast<double>(agreeing) / static_cast<double>(count);
    ratio.sigma = level.spread * std::sqrt(kCellsPerError / static_cast<double>(std::max<size_t>(level.inside, 1)));
    for (uint32_t c = 0; c < grid.channels; c++) {  // white balance: cells change less in colour than in brightness
        if (c == main) continue;
        std::vector<float> colour(count);
        for (size_t n = 0; n < count; n++) colour[n] = d.ev[c][n] - d.ev[main][n];
        ratio.ev[c] = level.middle + locate(colour, weight, kNarrowest).middle;
    }
    return ratio;
}

// One step of Gauss and Newton towards the shift that makes the cells agree: residual = gain - gradient . shift.
bool improve_shift(const FrameGrid &grid, const FrameCells &before, const FrameCells &after, CellShift &shift) {
    const std::vector<float> &a = before.soft[main_channel(grid)], &b = after.soft[main_channel(grid)];
    double h[3][3] = {}, g[3] = {};
    std::vector<float> residuals;
    std::vector<std::array<double, 3>> terms;
    for (uint32_t j = 1; j + 1 < grid.rows; j++)
        for (uint32_t i = 1; i + 1 < grid.columns; i++) {
            const double x = i - shift[0], y = j - shift[1];
            const float residual = b[size_t(j) * grid.columns + i] - cell_at(grid, a, x, y);
            const float dx = (cell_at(grid, a, x + 1, y) - cell_at(grid, a, x - 1, y)) / 2.0f;
            const float dy = (cell_at(grid, a, x, y + 1) - cell_at(grid, a, x, y - 1)) / 2.0f;
            if (!std::isfinite(residual) || !std::isfinite(dx) || !std::isfinite(dy)) continue;
            residuals.push_back(residual);
            terms.push_back({-static_cast<double>(dx), -static_cast<double>(dy), 1.0});
        }
    if (residuals.size() < kFewestCells) return false;
    const auto [middle, spread] = narrowest_third(residuals);
    const double limit = kTukey * std::max(spread, 5.0 * kNarrowest);
    for (size_t n = 0; n < residuals.size(); n++) {
        const double residual = static_cast<double>(residuals[n]) - middle, share = residual / limit;
        if (std::abs(share) >= 1.0) continue;
        const double weight = (1.0 - share * share) * (1.0 - share * share);
        for (size_t r = 0; r < 3; r++) {
            g[r] += weight * terms[n][r] * residual;
            for (size_t c = 0; c < 3; c++) h[r][c] += weight * terms[n][r] * terms[n][c];
        }
    }
    // The gain is eliminated first.
    const double xx = h[0][0] - h[0][2] * h[2][0] / h[2][2], xy = h[0][1] - h[0][2] * h[2][1] / h[2][2],
                 yy = h[1][1] - h[1][2] * h[2][1] / h[2][2];
    const double gx = g[0] - h[0][2] * g[2] / h[2][2], gy = g[1] - h[1][2] * g[2] / h[2][2];
    const double ridge = 1e-6 * (xx + yy), det = (xx + ridge) * (yy + ridge) - xy * xy;
    if (!(det > 0.0)) return false;
    const double step_x = ((yy + ridge) * gx - xy * gy) / det, step_y = ((xx + ridge) * gy - xy * gx) / det;
    const double length = std::hypot(step_x, step_y), scale = length > 1.5 ? 1.5 / length : 1.0;
    shift[0] += scale * step_x, shift[1] += scale * step_y;
    return scale * length > kSmallestShift / 4.0;
}

}  // namespace

bool FrameRatio::is_valid() const { return agreeing >= kSmallestAgreeing && common >= kSmallestCommon; }

float cell_at(const FrameGrid &grid, const std::vector<float> &cells, double column, double row) {
    if (!(column >= 0.0 && row >= 0.0 && column <= grid.columns - 1.0 && row <= grid.rows - 1.0)) return NAN;
    const auto i = std::min(static_cast<size_t>(column), size_t(grid.columns) - (grid.columns > 1 ? 2 : 1));
    const auto j = std::min(static_cast<size_t>(row), size_t(grid.rows) - (grid.rows > 1 ? 2 : 1));
    const size_t right = grid.columns > 1 ? 1 : 0, below = grid.rows > 1 ? grid.columns : 0;
    const auto u = static_cast<float>(column - static_cast<double>(i)),
               v = static_cast<float>(row - static_cast<double>(j));
    const float *cell = &cells[j * grid.columns + i];
    return (1 - v) * ((1 - u) * cell[0] + u * cell[right]) + v * ((1 - u) * cell[below] + u * cell[below + right]);
}

FrameRatio compare_frames(const FrameGrid &grid, const FrameCells &before, const FrameCells &after,
                          const std::vector<float> &steadiness, const CellShift &shift) {
    return ratio_of(grid, differences_of(grid, before, after, steadiness, shift), shift);
}

FrameRatio register_frames(const FrameGrid &grid, const FrameCells &before, const FrameCells &after,
                           const std::vector<float> &steadiness, const CellShift &guess) {
    FrameRatio still = compare_frames(grid, before, after, steadiness, guess);
    CellShift shift = guess;
    const auto is_within = [&] {
        return std::abs(shift[0]) < grid.columns / 2.0 && std::abs(shift[1]) < grid.rows / 2.0;
    };
    for (int step = 0; step < kSearchSteps && is_within(); step++)
        if (!improve_shift(grid, before, after, shift)) break;
    if (!is_within() || std::hypot(shift[0] - guess[0], shift[1] - guess[1]) < kSmallestShift) return still;
    const FrameRatio moved = compare_frames(grid, before, after, steadiness, shift);
    const bool is_better = moved.is_valid()
                           && (!still.is_valid() || moved.spread < kWorthwhile * still.spread
                               || moved.agreeing > still.agreeing / kWorthwhile);
    return is_better ? moved : still;
}

}  // namespace lensprof
