// The part of a frame that a map of a falloff knows, if the rest is dark, such as the surround of a fisheye's circle.
#pragma once

#include <optional>

#include "falloff/map_fit.hpp"

namespace lensprof {

// Half diagonals of the frame, from its middle.
struct Circle {
    double center[2], radius;
};

// Marks what is dark next to an edge as not known, with the edge itself, where pixels are means of both sides. Returns
// the circle that is left if what is left is one, or the part of one within the frame.
std::optional<Circle> drop_surround(FalloffMap &map);

}  // namespace lensprof
