// A frame, reduced to the logarithms of the mean irradiance of cells.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <lensprof/apply.h>
#include <lensprof/model.h>

namespace lensprof {

// The irradiance of every value of an integer sample, per channel.
class CellTables {
public:
    // `response`: 1 or 3, or none for the transfer function of sRGB, and linear float samples.
    CellTables(const std::vector<lensprof_response> &response, uint32_t sample);

    float irradiance(uint32_t channel, const uint8_t *row, size_t n) const;

private:
    const uint32_t sample_;
    std::vector<lensprof_response> response_;
    std::vector<float> table_[3];
};

// Where the cells of a frame are.
struct FrameGrid {
    uint32_t width = 0, height = 0;                     // of the frame, px
    uint32_t left = 0, top = 0, right = 0, bottom = 0;  // of what is compared, px
    uint32_t columns = 0, rows = 0, channels = 0;

    FrameGrid() = default;
    FrameGrid(const lensprof_image &frame, const double *region);

    size_t cells() const { return size_t(columns) * rows; }
};

struct FrameCells {
    std::array<std::vector<float>, 3> ev;    // log2 of the mean irradiance; NaN: saturated, or dark
    std::array<std::vector<float>, 3> soft;  // of 3 x 3 cells, for comparison at fractions of a cell
    double white_share = 0, dark_share = 0, valid_share = 0;
};

FrameCells reduce_frame(const FrameGrid &grid, const CellTables &tables, const lensprof_image &frame);

}  // namespace lensprof
