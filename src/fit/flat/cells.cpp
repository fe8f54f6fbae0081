#include "fit/flat/cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/levels.h"
#include "fit/base/constants.hpp"
#include "fit/base/lanes.hpp"
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
constexpr float kFarDifference = 4.0f;   // sigmas of a difference of neighbours: across an edge
constexpr double kMinLowPixels = 4.0;    // pixels far below the rest: fewer occur by chance, or are single dead pixels
constexpr size_t kNoiseLevels = 8;       // grey levels of a noise curve
constexpr size_t kScaleValues = 60;      // from which medians of a cell are taken, at least: their error is 0.16 sigma,
                                         // and the mean, of all pixels within three, barely depends on them

// One step of the samples: the smallest difference of two neighbours that are not equal.
float quantum(uint32_t sample) {
    return sample == LENSPROF_SAMPLE_U8 ? 1.0f / 255.0f : sample == LENSPROF_SAMPLE_U16 ? 1.0f / 65535.0f : 1e-7f;
}

// Median of equally spaced ones of many values.
template <class Value>
float typical(const std::vector<float> &values, const Value &value) {
    const size_t step = std::max<size_t>(values.size() / kScaleValues, 1);
    std::vector<float> some;
    some.reserve(2 * kScaleValues);
    for (size_t i = step / 2; i < values.size(); i += step) some.push_back(value(values[i]));
    return median(some);
}

float typical_distance(const std::vector<float> &values, float center) {
    return static_cast<float>(kMadToSigma) * typical(values, [&](float value) { return std::abs(value - center); });
}

// Sums over the values within `limit` of `center`, of their distances from it, and the number of those below `low`.
struct Near {
    double sum = 0.0, squares = 0.0, count = 0.0, below = 0.0;
};

Near near(const std::vector<float> &values, float center, float limit, float low) {
    const Lanes none{}, one = none + 1.0f;
    Lanes sum{}, squares{}, count{}, below{};
    const auto add = [&](const Lanes &value) {
        const Lanes distance = value - center, away = distance < 0.0f ? -distance : distance;
        const Lanes within = away <= limit ? distance : none;
        sum += within;
        squares += within * within;
        count += away <= limit ? one : none;
        below += value < low ? one : none;
    };
    size_t i = 0;
    for (Lanes value; i + kLanes <= values.size(); i += kLanes) {
        std::memcpy(&value, &values[i], sizeof value);
        add(value);
    }
    Lanes last = none + std::numeric_limits<float>::quiet_NaN();  // is neither near nor below
    for (size_t lane = 0; i < values.size(); i++, lane++) last[lane] = values[i];
    add(last);
    const auto total = [](const Lanes &lanes) {
        return static_cast<double>((lanes[0] + lanes[1]) + (lanes[2] + lanes[3]));
    };
    return {total(sum), total(squares), total(count), total(below)};
}

// Standard deviation of a pixel from differences of neighbours, excluding those across edges.
float noise_of(const std::vector<float> &differences, float step) {
    if (differences.empty()) return step;
    double sum = 0.0;
    for (const float difference : differences) sum += static_cast<double>(difference);
    const auto slope = static_cast<float>(sum / static_cast<double>(differences.size()));
    const float limit = kFarDifference * std::max(typical_distance(differences, slope), step);
    const Near near_slope = near(differences, slope, limit, slope);
    const float rounding = step / std::sqrt(12.0f);
    return std::max(static_cast<float>(std::sqrt(0.5 * near_slope.squares / std::max(near_slope.count, 1.0))),
                    rounding);
}

struct Robust {
    float mean, low_share;
};

// Mean of the values near the median, and the share of those far below it.
Robust robust_mean_of(const std::vector<float> &values, float noise) {
    const float center = typical(values, [](float value) { return value; });
    const float spread = std::max(typical_distance(values, center), noise);
    const Near near_center = near(values, center, kCut * spread, center - kFar * spread);
    return {center + static_cast<float>(near_center.sum / std::max(near_center.count, 1.0)),
            near_center.below < kMinLowPixels
                ? 0.0f
                : static_cast<float>(near_center.below / static_cast<double>(values.size()))};
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
        for (auto &values : values_) values.resize(width * rows);
        allowed_.resize(width * rows);
        std::vector<float> colours(3 * width);
        for (size_t v = 0; v < rows; v++) {
            view.row(top_ + static_cast<int>(v), colours.data(), &allowed_[width * v]);
            for (size_t c = 0; c < 3; c++) {
                float *out = &values_[c][width * v];
                const float *in = &colours[c];
                for (size_t u = 0; u < width; u++) out[u] = in[3 * u];
            }
        }
        if (lp_has_levels(&levels_)) take_levels();
    }

    void measure(int column, int channels, Cell &cell) {
        find_runs(column);
        place(cell);
        if (cell.pixels < 4 || cell.pixels < kSmallestPart * expected_) return;
        size_t white = 0, black = 0;
        count_clipped(static_cast<size_t>(channels), white, black);
        double limit = kLargestBeyond * cell.pixels;
        const float step = quantum(image_.view.sample) / static_cast<float>(lp_level_span(&levels_, 1));
        cell.state = static_cast<double>(white) > limit   ? CellState::white
                     : static_cast<double>(black) > limit ? CellState::black
                                                          : CellState::used;
        for (size_t c = 0; c < static_cast<size_t>(channels); c++) {
            gather(values_[c]);
            cell.noise[c] = noise_of(differences_, step);
            Robust robust = robust_mean_of(cell_values_, std::max(cell.noise[c], step));
            cell.value[c] = robust.mean;
            cell.low_share = std::max(cell.low_share, robust.low_share);
        }
    }

private:
    // Samples to grey values. A grey picture has three equal channels, with the levels of green.
    void take_levels() {
        const bool is_grey = lensprof_layout_channels(image_.view.layout) == 1;
        for (size_t c = 0; c < 3; c++)
            for (float &value : values_[c])
                value = static_cast<float>(lensprof_levels_to_value(&levels_, static_cast<uint32_t>(is_grey ? 1 : c),
                                                                    static_cast<double>(value)));
    }

    // The allowed pixels of a cell.
    void find_runs(int column) {
        const auto first = across_[static_cast<size_t>(column)], last = across_[static_cast<size_t>(column) + 1];
        const auto width = static_cast<std::ptrdiff_t>(image_.view.width);
        runs_.clear();
        for (auto row = allowed_.begin(); row != allowed_.end(); row += width)
            for (auto at = row + first, end = at; at != row + last; at = end) {
                end = std::find_if(at, row + last, [&](uint8_t allowed) { return (allowed != 0) != (*at != 0); });
                if (*at) runs_.push_back({static_cast<size_t>(at - allowed_.begin()), static_cast<size_t>(end - at)});
            }
    }

    // Pixels of which a channel is white, or black.
    void count_clipped(size_t channels, size_t &white, size_t &black) const {
        const auto low = static_cast<float>(image_.black), high = static_cast<float>(image_.white);
        const float *first = values_[0].data(), *second = values_[channels / 2].data(),
                    *third = values_[channels - 1].data();
        uint32_t above = 0, below = 0;
        for (const Run &run : runs_)
            for (size_t i = run.first; i < run.first + run.count; i++) {
                above += std::max(first[i], std::max(second[i], third[i])) > high ? 1 : 0;
                below += std::min(first[i], std::min(second[i], third[i])) < low ? 1 : 0;
            }
        white = above, black = below;
    }

    void place(Cell &cell) const {
        double x = 0.0, y = 0.0, count = 0.0;
        for (const Run &run : runs_) {
            const auto pixels = static_cast<double>(run.count);
            x += pixels * (static_cast<double>(run.first % image_.view.width) + 0.5 * (pixels - 1.0));
            y += pixels * static_cast<double>(run.first / image_.view.width);
            count += pixels;
        }
        cell.pixels = static_cast<uint32_t>(count);
        cell.x = (x / std::max(count, 1.0) + 0.5) * image_.reduction - 0.5;
        cell.y = (y / std::max(count, 1.0) + top_ + 0.5) * image_.reduction - 0.5;
    }

    // The values of a cell, and the differences of neighbours along a row.
    void gather(const std::vector<float> &values) {
        cell_values_.clear();
        differences_.clear();
        for (const Run &run : runs_) {
            const float *first = &values[run.first];
            cell_values_.insert(cell_values_.end(), first, first + run.count);
            const size_t known = differences_.size();
            differences_.resize(known + run.count - 1);
            for (size_t i = 1; i < run.count; i++) differences_[known + i - 1] = first[i] - first[i - 1];
        }
    }

    const lensprof_sample_image &image_;
    const lensprof_levels &levels_;
    std::vector<int> across_;
    int top_ = 0, bottom_ = 0;
    double expected_ = 0.0;
    std::array<std::vector<float>, 3> values_;  // of the row of cells
    std::vector<uint8_t> allowed_;
    // Of one cell:
    struct Run {
        size_t first, count;  // pixels, in the row of cells
    };
    std::vector<Run> runs_;
    std::vector<float> cell_values_, differences_;  // of one channel
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
