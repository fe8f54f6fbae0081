// Steps that scenes are made of.
#pragma once

#include <cmath>

namespace lensprof {

inline double smooth(double t) { return t * t * (3.0 - 2.0 * t); }

inline double mix(double a, double b, double t) { return a + (b - a) * t; }

// 0 below `low`, 1 above `high`, smooth between.
inline double ramp(double low, double high, double x) {
    return smooth(std::fmin(std::fmax((x - low) / (high - low), 0.0), 1.0));
}

// 1 on a line about 0 of this half width, 0 off it.
inline double line(double distance, double half_width) {
    return 1.0 - ramp(0.6 * half_width, 1.4 * half_width, std::fabs(distance));
}

// From the nearest whole number.
inline double from_whole(double x) { return x - std::floor(x + 0.5); }

}  // namespace lensprof
