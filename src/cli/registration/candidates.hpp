// Which pairs of pictures are worth matching: those that look alike as a whole, and neighbours in the sequence.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "cli/registration/features.hpp"

namespace lensprof {

using PicturePair = std::pair<uint32_t, uint32_t>;  // numbers, the lower one first

// All pairs of few pictures. Of many every picture with those next to it and with the ones most like it, by vectors of
// locally aggregated descriptors (Jegou et al. 2010), so that their number grows with the pictures and not with its
// square. Sorted.
std::vector<PicturePair> candidate_pairs(const std::vector<Features> &pictures);

// What few links have found: pictures that are linked to one and the same picture with few links, and were not
// candidates before.
std::vector<PicturePair> further_pairs(uint32_t pictures, const std::vector<PicturePair> &linked,
                                       const std::vector<PicturePair> &tried);

}  // namespace lensprof
