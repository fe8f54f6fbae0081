// What counts as r = 1 in other programs' falloffs, in one place (docs/formats.md). Here it is half the diagonal of the
// frame; a polynomial in another unit of radius is rescaled exactly.
#pragma once

#include <cmath>

#include <lensprof/model.h>

namespace lensprof {

// Half the diagonal, in mm, of a sensor with this crop factor: that of 36 mm x 24 mm over the crop factor.
inline double half_diagonal_mm(double crop_factor) { return std::hypot(36.0, 24.0) / 2.0 / crop_factor; }

// Half the shorter side in half diagonals, for a frame of this ratio of its sides: the unit of Lensfun's centres.
inline double half_short_side(double aspect_ratio) { return 1.0 / std::hypot(aspect_ratio, 1.0); }

// From the centre of a falloff, in half diagonals from that of the frame, to the frame's farthest corner.
inline double farthest_corner(const double center[2], uint32_t width, uint32_t height) {
    const double rho = lensprof_half_diagonal(width, height);
    return std::hypot(width / 2.0 / rho + std::fabs(center[0]), height / 2.0 / rho + std::fabs(center[1]));
}

}  // namespace lensprof
