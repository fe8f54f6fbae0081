// Falloffs that are known at places of a frame, to M and a gain grid: least squares of the relative error, as
// refit.hpp.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <lensprof/profile.h>

namespace lensprof {

// Attenuations at evenly spaced places of a frame.
struct FalloffMap {
    uint32_t width, height;           // of the frame, px
    uint32_t columns, rows;           // 1 and more
    uint32_t channels;                // 1 or 3
    double x0, dx, y0, dy;            // place of value (i, j): (x0 + i dx, y0 + j dy) px of the frame
    std::vector<double> attenuation;  // [channel][row][column], to any scale a channel; below 0.001 of the largest of
                                      // its channel: not known
};

// Attenuation of a channel at a place, px of a frame.
using Attenuation = std::function<double(double x, double y, uint32_t channel)>;

// An attenuation at places enough for a plane at each node of a grid.
FalloffMap sampled_map(uint32_t width, uint32_t height, uint32_t channels, const Attenuation &attenuation);

// The place of values that are the means of equal cells of the frame, as the pixels of a reduced picture are.
void place_as_cells(FalloffMap &map);

// One falloff a channel and their common centre; what they leave beyond 0.2 % becomes a gain grid. Sets vignetting,
// vignettings and grid; returns the largest |model / attenuation - 1|. Throws VIGNETTING where too little is known.
double fit_map(const FalloffMap &map, lensprof_profile &profile);

}  // namespace lensprof
