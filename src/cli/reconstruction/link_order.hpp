// Which images show the same, and an order in which those that do are near each other.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "cli/reconstruction/reconstruction.hpp"

namespace lensprof {

// Two images, the smaller number first, and how many points or matches they have in common.
using LinkWeights = std::map<std::pair<uint32_t, uint32_t>, uint32_t>;

// Of all images that share points. Points that more than 64 images see say little of which are alike, and do not count.
LinkWeights common_points(const Reconstruction &reconstruction);

// The images breadth first, along the links with most in common.
std::vector<uint32_t> order_by_links(uint32_t images, const LinkWeights &links);

}  // namespace lensprof
