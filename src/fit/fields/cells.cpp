#include "fit/fields/cells.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lensprof {
namespace {

constexpr int kCells = 64;              // along the longer side
constexpr uint32_t kMinPixels = 2;      // of the frame, along a cell
constexpr double kSmallestPart = 0.5;   // of a cell's pixels that must be usable
constexpr double kLargestWhite = 0.01;  // of them that may be saturated: more would bias the mean
constexpr double kTrimmed = 0.25;       // of a cell's pixels, at either end: things smaller than a cell
constexpr double kPile = 3.0;           // pixels at the largest value per pixel at the next three: the range ends there
constexpr double kSmallestPile = 16.0;  // pixels
constexpr float kNextPart = 1e-3f;      // of the range of float samples
constexpr float kNextValues = 3.5f;     // steps of the samples

float step_of(uint32_t sample) {
    return sample == LENSPROF_SAMPLE_U8 ? 1.0f / 255.0f : sample == LENSPROF_SAMPLE_U16 ? 1.0f / 65535.0f : 0.0f;
}

// A view with one row in memory.
class Rows {
public:
    Rows(const View &view, int channels)
        : channels_(channels), width_(view.image().view.width), view_(view), values_(3 * width_), allowed_(width_) {}

    void read(uint32_t v) {
        view_.row(static_cast<int>(v), values_.data(), allowed_.data());
        for (size_t u = 0; u < width_; u++)
            for (size_t c = 0; c < static_cast<size_t>(channels_); c++)
                if (!std::isfinite(values_[3 * u + c])) allowed_[u] = 0;
    }
    const float *at(size_t u) const { return &values_[3 * u]; }
    bool is_allowed(size_t u) const { return allowed_[u] != 0; }
    size_t width() const { return width_; }
    float largest(size_t u) const { return *std::max_element(at(u), at(u) + channels_); }

private:
    int channels_;
    size_t width_;
    const View &view_;
    std::vector<float> values_;
    std::vector<uint8_t> allowed_;
};

struct Range {
    float low = INFINITY, high = -INFINITY;
    double allowed = 0.0;
};

Range range_of(Rows &rows, uint32_t height) {
    Range range;
    for (uint32_t v = 0; v < height; v++) {
        rows.read(v);
        for (size_t u = 0; u < rows.width(); u++) {
            if (!rows.is_allowed(u)) continue;
            range.allowed += 1.0;
            range.low = std::min(range.low, rows.largest(u));
            range.high = std::max(range.high, rows.largest(u));
        }
    }
    return range;
}

// Where the samples of a picture end: `white`, or the largest value if pixels pile up there. `step`: of integer
// samples.
float end_of_range(Rows &rows, uint32_t height, const Range &range, float step, float white) {
    if (range.high <= range.low || range.high >= white) return white;
    const float own = step > 0.0f ? 0.5f * step : 0.0f;
    const float next = step > 0.0f ? kNextValues * step : kNextPart * (range.high - range.low);
    double at_end = 0.0, near_end = 0.0;
    for (uint32_t v = 0; v < height; v++) {
        rows.read(v);
        for (size_t u = 0; u < rows.width(); u++) {
            if (!rows.is_allowed(u)) continue;
            const float below = range.high - rows.largest(u);
            at_end += below <= own;
            near_end += below > own && below < next;
        }
    }
    return at_end >= kSmallestPile && at_end > kPile * near_end ? range.high - own : white;
}

float trimmed_mean(std::vector<float> &values) {
    const auto cut = static_cast<ptrdiff_t>(kTrimmed * static_cast<double>(values.size()));
    const auto first = values.begin() + cut, last = values.end() - cut;
    if (cut > 0) {
        std::nth_element(values.begin(), first, values.end());
        std::nth_element(first, last - 1, values.end());
    }
    double sum = 0.0;
    std::sort(first, last);  // the sum does not depend on the order of the pixels
    for (auto value = first; value != last; ++value) sum += static_cast<double>(*value);
    return static_cast<float>(sum / static_cast<double>(last - first));
}

// First pixel of each cell in one direction, in pixels of the view.
std::vector<uint32_t> borders(int cells, uint32_t frame, uint32_t view, uint32_t reduction) {
    std::vector<uint32_t> border;
    for (int i = 0; i <= cells; i++) {
        const double pixel = static_cast<double>(i) * frame / cells / reduction;  // its centre is at + 0.5
        border.push_back(std::min(static_cast<uint32_t>(std::max(0.0, std::ceil(pixel - 0.5))), view));
    }
    return border;
}

// The pixels of one row of cells.
struct RowOfCells {
    std::vector<std::array<std::vector<float>, 3>> values;  // per column of the grid
    std::vector<uint32_t> white;

    explicit RowOfCells(size_t columns) : values(columns), white(columns) {}

    void take(const Rows &rows, const std::vector<uint32_t> &across, int channels, float end) {
        for (size_t column = 0; column < values.size(); column++)
            for (uint32_t u = across[column]; u < across[column + 1]; u++) {
                if (!rows.is_allowed(u)) continue;
                white[column] += rows.largest(u) >= end;
                for (size_t c = 0; c < static_cast<size_t>(channels); c++) values[column][c].push_back(rows.at(u)[c]);
            }
    }
};

}  // namespace

FieldGrid make_field_grid(uint32_t width, uint32_t height) {
    const uint32_t longer = std::max(width, height);
    const int along = std::max(1, std::min(kCells, static_cast<int>(longer / kMinPixels)));
    const double side = static_cast<double>(longer) / along;
    const auto cells = [&](uint32_t pixels) { return std::max(1, static_cast<int>(std::lround(pixels / side))); };
    return {width, height, cells(width), cells(height)};
}

std::vector<float> finite_of(const std::vector<float> &values) {
    std::vector<float> finite;
    finite.reserve(values.size());
    std::copy_if(values.begin(), values.end(), std::back_inserter(finite), [](float v) { return !std::isnan(v); });
    return finite;
}

FieldCells measure_field(const FieldGrid &grid, const lensprof_sample_image &image, int channels) {
    const View view(image);
    Rows rows(view, channels);
    const uint32_t height = image.view.height;
    const Range range = range_of(rows, height);
    FieldCells found;
    found.pixel_share = range.allowed / (static_cast<double>(image.view.width) * height);
    found.range = range.allowed > 0.0 ? static_cast<double>(range.high - range.low) : 0.0;
    const float end = end_of_range(rows, height, range, step_of(image.view.sample), static_cast<float>(image.white));
    const std::vector<uint32_t> across = borders(grid.columns, grid.width, image.view.width, image.reduction);
    const std::vector<uint32_t> down = borders(grid.rows, grid.height, height, image.reduction);
    for (int c = 0; c < channels; c++) found.value[static_cast<size_t>(c)].assign(grid.count(), NAN);
    double white = 0.0, seen = 0.0;
    for (size_t row = 0; row < static_cast<size_t>(grid.rows); row++) {
        RowOfCells cells(static_cast<size_t>(grid.columns));
        for (uint32_t v = down[row]; v < down[row + 1]; v++) rows.read(v), cells.take(rows, across, channels, end);
        for (size_t column = 0; column < cells.values.size(); column++) {
            const double all = static_cast<double>(across[column + 1] - across[column]) * (down[row + 1] - down[row]);
            const auto pixels = static_cast<double>(cells.values[column][0].size());
            if (pixels < 1.0 || pixels < kSmallestPart * all) continue;
            const bool is_white = cells.white[column] > kLargestWhite * pixels;
            seen += 1.0, white += is_white;
            for (size_t c = 0; !is_white && c < static_cast<size_t>(channels); c++)
                found.value[c][row * cells.values.size() + column] = trimmed_mean(cells.values[column][c]);
        }
    }
    found.white_share = seen > 0.0 ? white / seen : 0.0;
    return found;
}

}  // namespace lensprof
