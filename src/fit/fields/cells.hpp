// Division of a picture of any scene into cells: trimmed means, without saturated and excluded pixels.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fit/sampling/view.hpp"

namespace lensprof {

// The frame divided into cells of nearly equal size; the same for all pictures.
struct FieldGrid {
    uint32_t width = 0, height = 0;  // frame, px
    int columns = 0, rows = 0;

    size_t count() const { return static_cast<size_t>(columns) * static_cast<size_t>(rows); }
};

// 64 cells along the longer side, fewer for frames below 128 px.
FieldGrid make_field_grid(uint32_t width, uint32_t height);

struct FieldCells {
    std::array<std::vector<float>, 3> value;  // per channel; NaN: too few pixels, or saturated ones among them
    double white_share = 0.0;                 // of the cells that have pixels: with saturated ones
    double pixel_share = 0.0;                 // of the frame: pixels that are neither excluded nor NaN
    double range = 0.0;                       // largest minus smallest value of a pixel
};

// The values of the cells that have one.
std::vector<float> finite_of(const std::vector<float> &values);

// Measures a picture. A pixel is left out if mask or alpha exclude it or a sample is not finite; it is saturated if a
// channel is at or above `white` or at the picture's own end of the range, where integer samples pile up.
FieldCells measure_field(const FieldGrid &grid, const lensprof_sample_image &image, int channels);

}  // namespace lensprof
