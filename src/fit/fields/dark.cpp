#include "fit/fields/dark.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

// Share of the variance of cells that neighbours have: 1 of noise, with a standard error of 1 / sqrt(cells), of which
// this many are allowed.
constexpr double kNoise = 5.5;

// Standard deviations of a pixel: by so much the offsets of dark pictures drift at most, and light that is not more
// than this is not seen.
constexpr double kDrift = 3.0;

double median_of(const std::vector<float> &cells) {
    std::vector<float> values = finite_of(cells);
    return static_cast<double>(median(values));
}

// Sum and number of squares.
struct Squares {
    double sum = 0.0, count = 0.0;
    void add(double value) {
        if (!std::isnan(value)) sum += value * value, count += 1.0;
    }
    double mean() const { return count > 0.0 ? sum / count : 0.0; }
};

double variance_of(const std::vector<double> &cells) {
    double sum = 0.0, count = 0.0;
    for (const double value : cells)
        if (!std::isnan(value)) sum += value, count += 1.0;
    Squares about_mean;
    for (const double value : cells) about_mean.add(value - sum / count);
    return about_mean.mean();
}

// Half the mean square of the difference of neighbours, over the variance (J. von Neumann, Ann. Math. Stat. 12, 367,
// 1941): 1 for noise, less for anything that is smooth. In one direction, because the noise of reading may be that of
// whole rows or columns.
bool is_noise(const FieldGrid &grid, const std::vector<double> &cells) {
    Squares across, down;
    const auto columns = static_cast<size_t>(grid.columns);
    for (size_t i = 0; i < cells.size(); i++) {
        if ((i + 1) % columns != 0) across.add(cells[i + 1] - cells[i]);
        if (i + columns < cells.size()) down.add(cells[i + columns] - cells[i]);
    }
    const double least = 1.0 - kNoise / std::sqrt(std::max(across.count, 1.0));
    return 0.5 * std::max(across.mean(), down.mean()) >= least * variance_of(cells);
}

// Whether a picture shows only noise in a channel, at a level that is not above `floor` by more than noise.
bool is_at_floor(const FieldsFit &fit, uint32_t picture, uint32_t channel, double floor) {
    const std::vector<float> &values = fit.pictures[picture].cells.value[channel];
    const std::vector<double> cells(values.begin(), values.end());
    const double pixels = double(fit.grid.width) * fit.grid.height / static_cast<double>(fit.grid.count());
    return is_noise(fit.grid, cells) && median_of(values) - floor <= kDrift * std::sqrt(variance_of(cells) * pixels);
}

double floor_of(const FieldsFit &fit, const std::vector<uint32_t> &used, uint32_t channel) {
    if (fit.options.given_offset) return fit.options.offset[channel];
    double low = INFINITY;
    for (const uint32_t i : used) low = std::min(low, median_of(fit.pictures[i].cells.value[channel]));
    return low;
}

std::vector<double> mean_of(const FieldsFit &fit, const std::vector<uint32_t> &pictures, uint32_t channel) {
    std::vector<double> mean(fit.grid.count(), 0.0);
    for (const uint32_t i : pictures) {
        const std::vector<float> &values = fit.pictures[i].cells.value[channel];
        const double level = median_of(values);
        for (size_t j = 0; j < mean.size(); j++) mean[j] += static_cast<double>(values[j]) - level;
    }
    return mean;
}

}  // namespace

std::vector<uint32_t> dark_pictures(const FieldsFit &fit, const std::vector<uint32_t> &used) {
    std::vector<uint32_t> dark = is_linear(fit) ? used : std::vector<uint32_t>{};
    for (uint32_t c = 0; c < fit.options.channels; c++) {
        const double floor = floor_of(fit, used, c);
        dark.erase(std::remove_if(dark.begin(), dark.end(),
                                  [&](uint32_t picture) { return !is_at_floor(fit, picture, c, floor); }),
                   dark.end());
    }
    for (uint32_t c = 0; c < fit.options.channels && !dark.empty(); c++)
        if (!is_noise(fit.grid, mean_of(fit, dark, c))) dark.clear();
    return dark;
}

}  // namespace lensprof
