#include "fit/deflicker/cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lensprof {
namespace {

constexpr uint32_t kCellsAcross = 96;   // along the longer side
constexpr float kWhite = 0.97f;         // integer samples at or above it are saturated, or next to what is
constexpr double kPlateau = 0.002;      // of the float samples at the largest value: it is that of saturation
constexpr double kLargestWhite = 0.02;  // of the pixels of a cell: more would bias the mean
constexpr double kDark8 = 6.0 / 255.0;  // mean sample of 8 bit
constexpr double kDark = 1.0 / 1024.0;  // mean sample of more bits

float value_of(uint32_t sample, const uint8_t *row, size_t n) {
    if (sample == LENSPROF_SAMPLE_U8) return static_cast<float>(row[n]) / 255.0f;
    if (sample == LENSPROF_SAMPLE_U16) {
        uint16_t code;
        std::memcpy(&code, row + 2 * n, sizeof code);
        return static_cast<float>(code) / 65535.0f;
    }
    float value;
    std::memcpy(&value, row + 4 * n, sizeof value);
    return value;
}

// Sums of one row of cells.
struct CellSums {
    std::array<std::vector<double>, 3> irradiance, value;
    std::vector<uint32_t> pixels, white;

    explicit CellSums(size_t columns) : pixels(columns), white(columns) {
        for (auto &sums : irradiance) sums.resize(columns);
        for (auto &sums : value) sums.resize(columns);
    }
    void clear() {
        for (auto &sums : irradiance) std::fill(sums.begin(), sums.end(), 0.0);
        for (auto &sums : value) std::fill(sums.begin(), sums.end(), 0.0);
        std::fill(pixels.begin(), pixels.end(), 0);
        std::fill(white.begin(), white.end(), 0);
    }
};

// The largest sample of a float frame if many have it, because it was clipped there; else infinity.
float plateau_of(const lensprof_image &frame) {
    const uint64_t samples = uint64_t(frame.width) * lensprof_layout_samples(frame.layout);
    float largest = -HUGE_VALF;
    uint64_t count = 0;
    for (uint32_t y = 0; y < frame.height; y++)
        for (uint64_t n = 0; n < samples; n++) {
            const auto *row = static_cast<const uint8_t *>(frame.data) + static_cast<ptrdiff_t>(y) * frame.row_bytes;
            const float value = value_of(frame.sample, row, n);
            if (value > largest && std::isfinite(value)) largest = value, count = 0;
            count += value == largest;
        }
    return static_cast<double>(count) > kPlateau * static_cast<double>(samples * frame.height) ? largest : HUGE_VALF;
}

// Irradiance smoothed with the weights 1, 2, 1; NaN where a cell of the nine is missing.
std::vector<float> soften(const FrameGrid &grid, const std::vector<float> &ev) {
    const size_t columns = grid.columns, rows = grid.rows;
    std::vector<float> light(ev.size()), across(ev.size(), NAN), soft(ev.size(), NAN);
    for (size_t n = 0; n < ev.size(); n++) light[n] = std::exp2(ev[n]);
    for (size_t j = 0; j < rows; j++)
        for (size_t i = 1; i + 1 < columns; i++) {
            const float *cell = &light[j * columns + i];
            across[j * columns + i] = cell[-1] + 2 * cell[0] + cell[1];
        }
    for (size_t j = 1; j + 1 < rows; j++)
        for (size_t i = 1; i + 1 < columns; i++) {
            const size_t n = j * columns + i;
            soft[n] = std::log2((across[n - columns] + 2 * across[n] + across[n + columns]) / 16);
        }
    return soft;
}

}  // namespace

CellTables::CellTables(const std::vector<lensprof_response> &response, uint32_t sample)
    : sample_(sample), response_(response) {
    if (sample == LENSPROF_SAMPLE_F32) return;
    if (response_.empty()) lensprof_response_set_srgb(&response_.emplace_back());
    const size_t codes = sample == LENSPROF_SAMPLE_U8 ? 256 : 65536;
    for (size_t c = 0; c < response_.size(); c++)
        for (size_t code = 0; code < codes; code++) {
            const double value = static_cast<double>(code) / static_cast<double>(codes - 1);
            table_[c].push_back(static_cast<float>(lensprof_response_invert(&response_[c], value, nullptr)));
        }
}

float CellTables::irradiance(uint32_t channel, const uint8_t *row, size_t n) const {
    const uint32_t c = response_.size() == 3 ? channel : 0;
    if (sample_ == LENSPROF_SAMPLE_U8) return table_[c][row[n]];
    const float value = value_of(sample_, row, n);
    if (sample_ == LENSPROF_SAMPLE_U16) return table_[c][static_cast<size_t>(value * 65535.0f + 0.5f)];
    if (response_.empty() || !(value >= 0.0f && value <= 1.0f)) return value;
    return static_cast<float>(lensprof_response_invert(&response_[c], static_cast<double>(value), nullptr));
}

FrameGrid::FrameGrid(const lensprof_image &frame, const double *region)
    : width(frame.width), height(frame.height), channels(lensprof_layout_channels(frame.layout)) {
    const auto place = [](double share, uint32_t side) {
        return static_cast<uint32_t>(std::lround(share * static_cast<double>(side)));
    };
    const bool is_whole = std::all_of(region, region + 4, [](double share) { return share == 0.0; });
    left = is_whole ? 0 : std::min(place(region[0], width), width - 1);
    top = is_whole ? 0 : std::min(place(region[1], height), height - 1);
    right = is_whole ? width : std::max(place(region[2], width), left + 1);
    bottom = is_whole ? height : std::max(place(region[3], height), top + 1);
    const uint32_t longer = std::max(right - left, bottom - top);
    const double cell = std::max(double(longer) / kCellsAcross, 1.0);
    columns = std::max(static_cast<uint32_t>(std::lround((right - left) / cell)), 1u);
    rows = std::max(static_cast<uint32_t>(std::lround((bottom - top) / cell)), 1u);
}

FrameCells reduce_frame(const FrameGrid &grid, const CellTables &tables, const lensprof_image &frame) {
    FrameCells cells;
    const float missing = std::nanf("");
    for (uint32_t c = 0; c < grid.channels; c++) cells.ev[c].assign(grid.cells(), missing);
    const uint32_t samples = lensprof_layout_samples(frame.layout);
    const double dark = frame.sample == LENSPROF_SAMPLE_U8 ? kDark8 : kDark;
    const uint32_t wide = grid.right - grid.left, high = grid.bottom - grid.top;
    std::vector<uint32_t> column_of(wide);
    for (uint32_t x = 0; x < wide; x++) column_of[x] = static_cast<uint32_t>(uint64_t(x) * grid.columns / wide);
    CellSums sums(grid.columns);
    uint64_t white = 0;
    size_t dark_cells = 0, valid = 0;
    const bool is_reversed = frame.layout == LENSPROF_LAYOUT_BGR || frame.layout == LENSPROF_LAYOUT_BGRA;
    const float limit = frame.sample == LENSPROF_SAMPLE_F32 ? plateau_of(frame) : kWhite;
    const auto add_row = [&](const uint8_t *row) {
        for (uint32_t x = 0; x < wide; x++) {
            const uint32_t column = column_of[x];
            bool is_white = false;
            for (uint32_t c = 0; c < grid.channels; c++) {
                const size_t n = size_t(grid.left + x) * samples + (is_reversed ? 2 - c : c);
                const float value = value_of(frame.sample, row, n);
                is_white = is_white || !(value < limit);
                sums.value[c][column] += static_cast<double>(value);
                sums.irradiance[c][column] += static_cast<double>(tables.irradiance(c, row, n));
            }
            sums.pixels[column]++;
            sums.white[column] += is_white;
            white += is_white;
        }
    };
    const auto take_cells = [&](uint32_t j) {
        for (uint32_t i = 0; i < grid.columns; i++) {
            const double pixels = sums.pixels[i];
            if (sums.white[i] > kLargestWhite * pixels) continue;
            bool is_dark = false;
            for (uint32_t c = 0; c < grid.channels; c++)
                is_dark = is_dark || !(sums.value[c][i] > dark * pixels && sums.irradiance[c][i] > 0.0);
            dark_cells += is_dark, valid += !is_dark;
            for (uint32_t c = 0; c < grid.channels && !is_dark; c++)
                cells.ev[c][size_t(j) * grid.columns + i] =
                    static_cast<float>(std::log2(sums.irradiance[c][i] / pixels));
        }
        sums.clear();
    };
    for (uint32_t y = 0, j = 0; y < high; y++) {
        add_row(static_cast<const uint8_t *>(frame.data) + static_cast<ptrdiff_t>(grid.top + y) * frame.row_bytes);
        const uint32_t next = static_cast<uint32_t>(uint64_t(y + 1) * grid.rows / high);
        if (next == j && y + 1 < high) continue;
        take_cells(j);
        j = next;
    }
    for (uint32_t c = 0; c < grid.channels; c++) cells.soft[c] = soften(grid, cells.ev[c]);
    const double all = static_cast<double>(grid.cells());
    cells.white_share = static_cast<double>(white) / (double(wide) * high);
    cells.dark_share = static_cast<double>(dark_cells) / all;
    cells.valid_share = static_cast<double>(valid) / all;
    return cells;
}

}  // namespace lensprof
