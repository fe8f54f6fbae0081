// Selects pairs of pictures worth matching: similar pictures, and neighbours in the sequence.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "photo/registration/features.hpp"

namespace lensprof {

using PicturePair = std::pair<uint32_t, uint32_t>;  // indices, the lower one first

// All pairs if there are few pictures. For many, each picture with its neighbours in the sequence and with the most
// similar ones, by VLAD descriptors (Jegou et al. 2010), so that the number of pairs grows
// linearly. Sorted.
std::vector<PicturePair> candidate_pairs(const std::vector<Features> &pictures);

// Further candidates found through few links: pictures linked to a common picture by few links that were not candidates
// before.
std::vector<PicturePair> further_pairs(uint32_t pictures, const std::vector<PicturePair> &linked,
                                       const std::vector<PicturePair> &tried);

}  // namespace lensprof
