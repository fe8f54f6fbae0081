// The part of a frame that a map of a falloff knows, if the rest is dark, such as the surround of a fisheye's circle.
#pragma once

#include <optional>

#include "falloff/circle.hpp"
#include "falloff/map_fit.hpp"

namespace lensprof {

struct KnownArea {
    std::optional<lensprof_image_circle> circle;  // if what is known is one, or the part of one within the frame
    double empty;                                 // share of the frame without values, or dark next to an edge
    double holes;  // share of the circle, of a rectangle in the middle, or of the frame, not known
};

// Marks what is dark next to an edge as not known, with the edge itself, where pixels are means of both sides.
KnownArea drop_surround(FalloffMap &map);

}  // namespace lensprof
