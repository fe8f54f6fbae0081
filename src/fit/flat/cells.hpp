// Division of a picture of an even light into cells: robust means, their noise, and clipping at black and white.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <lensprof/flat.h>

#include "fit/sampling/view.hpp"

namespace lensprof {

// The frame divided into cells of equal size; the same for all pictures.
struct CellGrid {
    uint32_t width = 0, height = 0;  // frame, px
    int columns = 0, rows = 0;

    int count() const { return columns * rows; }
    double cell_width() const { return static_cast<double>(width) / columns; }
    double cell_height() const { return static_cast<double>(height) / rows; }
    // From the upper left edge of the frame, px: 0.5 more than the coordinates of pixels.
    std::array<double, 2> middle(int cell) const {
        return {(cell % columns + 0.5) * cell_width(), (cell / columns + 0.5) * cell_height()};
    }
};

// About 96 cells along the longer side, and at least eight pixels of the smallest view along a cell.
CellGrid make_cell_grid(const lensprof_flat_image *images, uint32_t count);

enum class CellState : uint8_t {
    masked,  // less than nine tenths of its pixels are on the card, or in the view
    white,   // contains pixels above the white limit
    black,   // contains pixels below the black limit
    used
};

struct Cell {
    CellState state = CellState::masked;
    float low_share = 0.0f;  // share of pixels far darker than the rest, in the worst channel
    uint32_t pixels = 0;
    double x = 0.0, y = 0.0;       // centre of these pixels, px of the frame
    std::array<float, 3> value{};  // robust mean of the grey values
    std::array<float, 3> noise{};  // standard deviation of a pixel, from differences of neighbours
};

// Variance of a pixel as a function of its grey value: piecewise linear between medians over cells of one grey level.
struct NoiseCurve {
    std::vector<double> grey, variance;
    double at(double value) const;
};

struct CellPicture {
    std::vector<Cell> cells;
    std::array<NoiseCurve, 3> noise;  // per channel
};

// The picture in the form that the sampler reads; its camera has only the frame's size.
lensprof_sample_image sample_image_of(const lensprof_flat_image &image);

// Measures the cells of every picture, on several threads; false when cancelled.
bool measure_cells(const lensprof_flat_options &options, const lensprof_flat_image *images, uint32_t count,
                   const CellGrid &grid, std::vector<CellPicture> &pictures);

}  // namespace lensprof
