// The circle of an outline, such as the image circle of a fisheye.
#pragma once

#include <array>
#include <optional>
#include <vector>

namespace lensprof {

// Half diagonals of the frame, from its middle.
struct Circle {
    double center[2], radius;
};

// Through places in half diagonals, by least squares of |p|^2 = 2 a.p + b (Kasa 1976): the centre a, and b + |a|^2 the
// squared radius. Nothing if they are few, not within `slack` of a circle, or straight.
std::optional<Circle> circle_through(const std::vector<std::array<double, 2>> &places, double slack);

}  // namespace lensprof
