// Links between images that share points, and an order that keeps linked images close together.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "photo/reconstruction/reconstruction.hpp"

namespace lensprof {

// Two images, the smaller index first, and the number of points or matches they share.
using LinkWeights = std::map<std::pair<uint32_t, uint32_t>, uint32_t>;

// Links of all images that share points. Points seen by more than 64 images contain little information on similarity
// and are ignored.
LinkWeights common_points(const Reconstruction &reconstruction);

// The images in breadth-first order, following the strongest links first.
std::vector<uint32_t> order_by_links(uint32_t images, const LinkWeights &links);

}  // namespace lensprof
