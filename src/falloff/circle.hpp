// The circle of an outline, such as the image circle of a fisheye.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <lensprof/model.h>

namespace lensprof {

// Through places in half diagonals, by least squares of |p|^2 = 2 a.p + b (Kasa 1976): the centre a, and b + |a|^2 the
// squared radius. Nothing if they are fewer than `fewest`, not within `slack` of a circle, or straight.
std::optional<lensprof_image_circle> circle_through(const std::vector<std::array<double, 2>> &places, double slack,
                                                    size_t fewest = 16);

}  // namespace lensprof
