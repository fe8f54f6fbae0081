#include "fit/flat/cells.hpp"

#include <algorithm>
#include <cmath>

#include "core/levels.h"
#include "fit/base/constants.hpp"
#include "fit/base/parallel.hpp"
#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

constexpr int kCells = 96;               // along the longer side
constexpr int kMinPixels = 8;            // of the smallest view, along a cell
constexpr double kSmallestPart = 0.9;    // of a cell's pixels that must be on the card
constexpr double kLargestBeyond = 0.01;  // of a cell's pixels beyond black or white: more would bias its mean
constexpr float kCut = 3.0f;             // sigmas from the median that the mean includes
constexpr float kFar = 5.0f;             // sigmas: not noise
constexpr double kMinLowPixels = 4.0;    // pixels far below the rest: fewer occur by chance, or are single dead pixels
constexpr size_t kNoiseLevels = 8;       // grey levels of a noise curve
constexpr size_t kScaleValues = 120;     // from which medians of a cell are taken, at least: their error is 0.11 sigma,
                                         // and the mean, of all pixels within three, barely depends on them

// One step of the samples: the smallest difference of two neighbours that are not equal.
float quantum(uint32_t sample) {
    return sample == LENSPROF_SAMPLE_U8 ? 1.0f / 255.0f : sample == LENSPROF_SAMPLE_U16 ? 1.0f / 65535.0f : 1e-7f;
}

// Equally spaced values of many.
std::vector<float> thinned(const std::vector<float> &values) {
    const size_t step = std::max<size_t>(values.size() / kScaleValues, 1);
    std::vector<float> some;
    for (size_t i = step / 2; i < values.size(); i += step) some.push_back(values[i]);
    return some;
}

// Median, and the median distance from it.
struct Scale {
    float center, deviation;
};

Scale scale_of(const std::vector<float> &values) {
    std::vector<float> some = thinned(values);
    const float center = median(some);
    for (float &value : some) value = std::abs(value - center);
    return {center, static_cast<float>(kMadToSigma) * median(some)};
}

// Standard deviation of a pixel from differences of neighbours, excluding those across edges.
float noise_of(const std::vector<float> &differences, float step) {
    if (differences.empty()) return step;
    const Scale scale = scale_of(differences);
    const float limit = 4.0f * std::max(scale.deviation, step);
    double sum = 0.0, kept = 0.0;
    for (float difference : differences) {
        const float a = std::abs(difference - scale.center);
        if (a <= limit) sum += static_cast<double>(a) * a, kept += 1.0;
    }
    float rounding = step / std::sqrt(12.0f);
    return std::max(static_cast<float>(std::sqrt(0.5 * sum / std::max(kept, 1.0))), rounding);
}

struct Robust {
    float mean, low_share;
};

// Mean of the values near the median, and the share of those far below it.
Robust robust_mean_of(const std::vector<float> &values, float noise) {
    const Scale scale = scale_of(values);
    const float center = scale.center, spread = std::max(scale.deviation, noise);
    double sum = 0.0, kept = 0.0, low = 0.0;
    for (float v : values) {
        if (std::abs(v - center) <= kCut * spread) sum += v - center, kept += 1.0;
        low += v < center - kFar * spread;
    }
    return {center + static_cast<float>(sum / std::max(kept, 1.0)),
            low < kMinLowPixels ? 0.0f : static_cast<float>(low / static_cast<double>(values.size()))};
}

// First pixel of each cell in one direction, in pixels of the view.
std::vector<int> borders(int cells, uint32_t frame, uint32_t view, uint32_t reduction) {
    std::vector<int> border(static_cast<size_t>(cells) + 1);
    for (int i = 0; i <= cells; i++) {
        double pixel = static_cast<double>(i) * frame / cells / reduction;  // its centre is at + 0.5
        border[static_cast<size_t>(i)] = std::min(static_cast<int>(std::ceil(pixel - 0.5)), static_cast<int>(view));
    }
    return border;
}

class RowOfCells {
public:
    RowOfCells(const View &view, const lensprof_levels &levels, const CellGrid &grid, int row)
        : image_(view.image()), levels_(levels) {
        across_ = borders(grid.columns, grid.width, image_.view.width, image_.reduction);
        std::vector<int> down = borders(grid.rows, grid.height, image_.view.height, image_.reduction);
        top_ = down[static_cast<size_t>(row)], bottom_ = down[static_cast<size_t>(row) + 1];
        expected_ = grid.cell_width() * grid.cell_height() / image_.reduction / image_.reduction;
        size_t width = image_.view.width, rows = static_cast<size_t>(std::max(bottom_ - top_, 0));
        values_.resize(3 * width * rows);
        allowed_.resize(width * rows);
        for (size_t v = 0; v < rows; v++)
            view.row(top_ + static_cast<int>(v), &values_[3 * width * v], &allowed_[width * v]);
        if (lp_has_levels(&levels_)) take_levels();
    }

    void measure(int column, int channels, Cell &cell) {
        size_t white = 0, black = 0;
        gather(column, channels, white, black, cell);
        cell.pixels = static_cast<uint32_t>(cell_values_[0].size());
        if (cell.pixels < 4 || cell.pixels < kSmallestPart * expected_) return;
        double limit = kLargestBeyond * cell.pixels;
        const float step = quantum(image_.view.sample) / static_cast<float>(lp_level_span(&levels_, 1));
        cell.state = static_cast<double>(white) > limit   ? CellState::white
                     : static_cast<double>(black) > limit ? CellState::black
                                                          : CellState::used;
        for (size_t c = 0; c < static_cast<size_t>(channels); c++) {
            cell.noise[c] = noise_of(differences_[c], step);
            Robust robust = robust_mean_of(cell_values_[c], std::max(cell.noise[c], step));
            cell.value[c] = robust.mean;
            cell.low_share = std::max(cell.low_share, robust.low_share);
        }
    }

private:
    // Samples to grey values. A grey picture has three equal channels, with the levels of green.
    void take_levels() {
        const bool is_grey = lensprof_layout_channels(image_.view.layout) == 1;
        for (size_t i = 0; i < values_.size(); i++) {
            const auto channel = static_cast<uint32_t>(is_grey ? 1 : i % 3);
            const auto sample = static_cast<double>(values_[i]);
            values_[i] = static_cast<float>(lensprof_levels_to_value(&levels_, channel, sample));
        }
    }

    void gather(int column, int channels, size_t &white, size_t &black, Cell &cell) {
        for (auto &values : cell_values_) values.clear();
        for (auto &differences : differences_) differences.clear();
        const auto low = static_cast<float>(image_.black), high = static_cast<float>(image_.white);
        const size_t first = static_cast<size_t>(across_[static_cast<size_t>(column)]),
                     last = static_cast<size_t>(across_[static_cast<size_t>(column) + 1]), width = image_.view.width;
        for (size_t v = 0; v < allowed_.size() / width; v++)
            for (size_t u = first; u < last; u++) {
                const size_t index = width * v + u;
                if (!allowed_[index]) continue;
                cell.x += static_cast<double>(u);
                cell.y += static_cast<double>(v);
                const float *rgb = &values_[3 * index];
                bool above = false, below = false;
                for (size_t c = 0; c < static_cast<size_t>(channels); c++) {
                    cell_values_[c].push_back(rgb[c]);
                    above |= rgb[c] > high;
                    below |= rgb[c] < low;
                    if (u > first && allowed_[index - 1])
                        differences_[c].push_back(rgb[c] - values_[3 * (index - 1) + c]);
                }
                white += above, black += below;
            }
        const auto count = static_cast<double>(std::max<size_t>(cell_values_[0].size(), 1));
        cell.x = (cell.x / count + 0.5) * image_.reduction - 0.5;
        cell.y = (cell.y / count + top_ + 0.5) * image_.reduction - 0.5;
    }

    const lensprof_sample_image &image_;
    const lensprof_levels &levels_;
    std::vector<int> across_;
    int top_ = 0, bottom_ = 0;
    double expected_ = 0.0;
    std::vector<float> values_;
    std::vector<uint8_t> allowed_;
    std::array<std::vector<float>, 3> cell_values_, differences_;
};

NoiseCurve noise_curve(const std::vector<Cell> &cells, size_t channel) {
    std::vector<std::pair<float, float>> seen;  // grey value, noise
    for (const Cell &cell : cells)
        if (cell.state == CellState::used) seen.emplace_back(cell.value[channel], cell.noise[channel]);
    std::sort(seen.begin(), seen.end());
    NoiseCurve curve;
    size_t levels = std::min(kNoiseLevels, seen.size() / 8 + !seen.empty());
    for (size_t k = 0; k < levels; k++) {
        std::vector<double> grey, variance;
        for (size_t i = k * seen.size() / levels; i < (k + 1) * seen.size() / levels; i++) {
            grey.push_back(seen[i].first);
            variance.push_back(static_cast<double>(seen[i].second) * seen[i].second);
        }
        curve.grey.push_back(median(grey));
        curve.variance.push_back(median(variance));
    }
    return curve;
}

}  // namespace

CellGrid make_cell_grid(const lensprof_flat_image *images, uint32_t count) {
    CellGrid grid;
    grid.width = images[0].width, grid.height = images[0].height;
    uint32_t longer = UINT32_MAX;
    for (uint32_t i = 0; i < count; i++)
        longer = std::min(longer, std::max(images[i].view.width, images[i].view.height));
    int along = std::max(1, std::min(kCells, static_cast<int>(longer) / kMinPixels));
    double side = static_cast<double>(std::max(grid.width, grid.height)) / along;
    grid.columns = std::max(1, static_cast<int>(std::lround(grid.width / side)));
    grid.rows = std::max(1, static_cast<int>(std::lround(grid.height / side)));
    return grid;
}

double NoiseCurve::at(double value) const {
    if (grey.empty()) return 0.0;
    size_t above = static_cast<size_t>(std::upper_bound(grey.begin(), grey.end(), value) - grey.begin());
    if (above == 0) return variance.front();
    if (above == grey.size()) return variance.back();
    double share = (value - grey[above - 1]) / (grey[above] - grey[above - 1]);
    return variance[above - 1] + share * (variance[above] - variance[above - 1]);
}

lensprof_sample_image sample_image_of(const lensprof_flat_image &image) {
    lensprof_sample_image sample{};
    sample.view = image.view;
    sample.camera.width = image.width;
    sample.camera.height = image.height;
    sample.reduction = image.reduction;
    sample.mask = image.mask;
    sample.mask_row_bytes = image.mask_row_bytes;
    sample.black = image.black;
    sample.white = image.white;
    return sample;
}

bool measure_cells(const lensprof_flat_options &options, const lensprof_flat_image *images, uint32_t count,
                   const CellGrid &grid, std::vector<CellPicture> &pictures) {
    const auto rows = static_cast<uint32_t>(grid.rows);
    const int channels = static_cast<int>(options.channels);
    std::vector<lensprof_sample_image> samples;
    for (uint32_t i = 0; i < count; i++) samples.push_back(sample_image_of(images[i]));
    pictures.assign(count, {});
    for (auto &picture : pictures) picture.cells.resize(static_cast<size_t>(grid.count()));
    uint32_t done = 0;  // rows that the calling thread knows to be complete: a lower bound of the progress
    auto work = [&](uint32_t k) {
        View view(samples[k / rows]);
        int row = static_cast<int>(k % rows);
        RowOfCells cells(view, options.levels, grid, row);
        for (int column = 0; column < grid.columns; column++)
            cells.measure(column, channels, pictures[k / rows].cells[static_cast<size_t>(row * grid.columns + column)]);
    };
    auto stop = [&] {
        double part = std::min(1.0, static_cast<double>(++done) / (static_cast<double>(count) * rows));
        return options.progress && options.progress(0.8 * part, options.progress_user) != 0;
    };
    if (!for_each_parallel(count * rows, options.threads, work, stop)) return false;
    for (auto &picture : pictures)
        for (size_t c = 0; c < options.channels; c++) picture.noise[c] = noise_curve(picture.cells, c);
    return true;
}

}  // namespace lensprof
