// Dust: small places that are darker than their surroundings, on the sensor or on the card.
#include <algorithm>
#include <cmath>

#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"
#include "fit/flat/fit.hpp"

namespace lensprof {
namespace {

constexpr int kSurroundings = 5;          // cells about a cell
constexpr double kFarBelow = 5.5;         // sigmas below the surroundings
constexpr double kSmallestDepth = 0.004;  // of the light: one level of 255
constexpr double kLowShare = 0.02;        // of a cell's pixels far below the rest
constexpr size_t kLargestSpot = 60;       // cells: anything larger is not dust

struct SpotMap {
    std::vector<double> below;  // per cell: light minus that of its surroundings, relative; 0 without data
    std::vector<bool> dark;
};

// Standard deviation of the mean over a cell's channels from the noise of its pixels, relative to the light.
std::vector<double> noise_of_shot(const FlatFit &fit, int shot) {
    const Shot &shot_data = fit.shots[static_cast<size_t>(shot)];
    const auto channels = static_cast<size_t>(fit.problem.model.channels);
    std::vector<double> noise(shot_data.light.size(), 1.0);
    for (size_t i = 0; i < noise.size(); i++) {
        double sum = 0.0;
        for (size_t c = 0; c < channels && shot_data.light[i].state == CellState::used; c++)
            sum += shot_data.light[i].variance[c] / (shot_data.light[i].value[c] * shot_data.light[i].value[c]);
        if (sum > 0.0) noise[i] = std::sqrt(sum) / static_cast<double>(channels);
    }
    return noise;
}

SpotMap spots_of_shot(const FlatFit &fit, int shot) {
    const CellGrid &grid = fit.grid;
    const auto count = static_cast<size_t>(grid.count());
    const int channels = fit.problem.model.channels;
    std::vector<double> residual(count, 0.0);
    for (int c = 0; c < channels; c++) {
        std::vector<double> channel_residual = residual_map(fit, shot, c, nullptr, true);
        for (size_t i = 0; i < count; i++) residual[i] += channel_residual[i] / channels;
    }
    SpotMap map{std::vector<double>(count), std::vector<bool>(count)};
    const std::vector<double> noise = noise_of_shot(fit, shot);
    std::vector<double> size;
    for (size_t i = 0; i < count; i++) {
        if (std::isnan(residual[i])) continue;
        const int column = static_cast<int>(i) % grid.columns, row = static_cast<int>(i) / grid.columns;
        // symmetric, so that a slope towards the corners does not look like a spot
        const int across = std::min({kSurroundings, column, grid.columns - 1 - column});
        const int down = std::min({kSurroundings, row, grid.rows - 1 - row});
        std::vector<double> surroundings;
        for (int y = row - down; y <= row + down; y++)
            for (int x = column - across; x <= column + across; x++) {
                double value = residual[static_cast<size_t>(y * grid.columns + x)];
                if (!std::isnan(value)) surroundings.push_back(value);
            }
        map.below[i] = residual[i] - median(surroundings);
        size.push_back(std::abs(map.below[i]) / noise[i]);
    }
    const double sigma = std::max(kMadToSigma * median(size), 1.0);
    for (size_t i = 0; i < count; i++)
        map.dark[i] = map.below[i] < -std::max(kFarBelow * sigma * noise[i], kSmallestDepth)
                      || (!std::isnan(residual[i])
                          && static_cast<double>(fit.shots[static_cast<size_t>(shot)].light[i].low_share) > kLowShare);
    return map;
}

void leave_out(const CellGrid &grid, int cell, std::vector<bool> &left_out) {
    const int column = cell % grid.columns, row = cell / grid.columns;
    for (int y = std::max(0, row - 1); y <= std::min(grid.rows - 1, row + 1); y++)
        for (int x = std::max(0, column - 1); x <= std::min(grid.columns - 1, column + 1); x++)
            left_out[static_cast<size_t>(y * grid.columns + x)] = true;
}

// Leaves a group of dark cells out of the shots that show it.
lensprof_flat_spot take_spot(FlatFit &fit, const std::vector<SpotMap> &maps, const std::vector<int> &group) {
    lensprof_flat_spot spot{};
    for (int cell : group) {
        const auto [x, y] = fit.grid.middle(cell);
        spot.x += (x - 0.5) / static_cast<double>(group.size());
        spot.y += (y - 0.5) / static_cast<double>(group.size());
    }
    spot.radius = std::sqrt(static_cast<double>(group.size()) * fit.grid.cell_width() * fit.grid.cell_height() / kPi);
    for (size_t s = 0; s < maps.size(); s++) {
        bool shown = false;
        for (int cell : group) {
            if (!maps[s].dark[static_cast<size_t>(cell)]) continue;
            shown = true;
            spot.depth = std::max(spot.depth, -maps[s].below[static_cast<size_t>(cell)]);
            leave_out(fit.grid, cell, fit.left_out[s]);
        }
        spot.shots += shown;
    }
    return spot;
}

}  // namespace

void find_spots(FlatFit &fit, FlatResult &result) {
    std::vector<SpotMap> maps;
    std::vector<bool> dark(static_cast<size_t>(fit.grid.count()));
    for (int s = 0; s < fit.problem.model.shots; s++) {
        maps.push_back(spots_of_shot(fit, s));
        for (size_t i = 0; i < dark.size(); i++) dark[i] = dark[i] || maps.back().dark[i];
    }
    std::vector<lensprof_flat_spot> spots;
    for (const auto &group : connected_cells(fit.grid, dark, [](int, int) { return true; }))
        if (group.size() <= kLargestSpot) spots.push_back(take_spot(fit, maps, group));
    std::stable_sort(spots.begin(), spots.end(),
                     [](const lensprof_flat_spot &a, const lensprof_flat_spot &b) { return a.radius > b.radius; });
    result.spots = static_cast<uint32_t>(spots.size());
    std::fill_n(result.spot, LENSPROF_FLAT_SPOTS, lensprof_flat_spot{});
    std::copy_n(spots.begin(), std::min<size_t>(spots.size(), LENSPROF_FLAT_SPOTS), result.spot);
}

}  // namespace lensprof
