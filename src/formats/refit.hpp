// Falloffs of other shapes than ours (gains, higher powers, knots, maps), to M = 1 + k1 r^2 + k2 r^4 + k3 r^6 and a gain
// grid. Least squares of the relative error M / attenuation - 1, which is that of a corrected value: a truncated series
// of 1 / gain, which other programs use, is wrong by up to a quarter at two stops.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include <lensprof/profile.h>

namespace lensprof {

// 1 + terms[0] t + terms[1] t^2 + ... for a target sampled evenly in t over 0..1, target(0) taken as 1. Throws NOT_FINITE
// or VIGNETTING for what is not finite, or not above 0, there.
struct EvenRefit {
    std::vector<double> terms;
    double worst;  // largest |polynomial / target - 1|
};
EvenRefit refit_even(const std::function<double(double t)> &target, uint32_t count);

// A radial attenuation, r^2 in half diagonals, sampled evenly in r^2, that is evenly over the area, up to r = `reach`
// half diagonals. The attenuation in the centre is taken as 1. Throws as refit_even.
struct RadialRefit {
    std::array<double, 3> k;
    double worst;  // largest |M / attenuation - 1|
};
RadialRefit refit_radial(const std::function<double(double r2)> &attenuation, double reach = 1.0);

// Attenuations at evenly spaced places of a frame.
struct FalloffMap {
    uint32_t width, height;         // of the frame, px
    uint32_t columns, rows;         // 1 and more
    uint32_t channels;              // 1 or 3
    double x0, dx, y0, dy;          // place of value (i, j): (x0 + i dx, y0 + j dy) px of the frame
    std::vector<double> attenuation;  // [channel][row][column], to any scale a channel; below 0.001 of the largest of
                                      // its channel: not known
};

// The place of values that are the means of equal cells of the frame, as the pixels of a reduced picture are.
void place_as_cells(FalloffMap &map);

// One falloff a channel and their common centre; what they leave beyond 0.2 % becomes a gain grid. Sets vignetting,
// vignettings and grid; returns the largest |model / attenuation - 1|. Throws VIGNETTING where too little is known.
double fit_map(const FalloffMap &map, lensprof_profile &profile);

// Attenuation of a profile at a place of a frame: falloff times gain grid.
double profile_attenuation(const lensprof_profile &profile, uint32_t width, uint32_t height, double x, double y,
                           uint32_t channel);

}  // namespace lensprof
