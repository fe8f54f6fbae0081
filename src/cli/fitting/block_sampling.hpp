// Pairs at the matches of a reconstruction, whose pictures may be too many to be held in memory together.
#pragma once

#include <vector>

#include "cli/fitting/project.hpp"

namespace lensprof {

// Most bytes of the pictures of a block.
constexpr uint64_t usual_block_bytes = uint64_t(512) << 20;

// Measures pairs at the project's matches, each of two blocks of pictures that are read together: images that share
// matches are in few blocks, so that every picture is read a few times. `links` receives those of the images, `points`
// the scene point of each pair. options.pairs: 0 = one a match. Channels: 3, or 1 where every picture is grey, which
// *channels receives.
std::vector<lensprof_pair> sample_in_blocks(const Project &project, const lensprof_sample_options &options,
                                            uint32_t max_side, uint64_t block_bytes, Progress &progress,
                                            std::vector<lensprof_link> &links, std::vector<uint32_t> &points,
                                            uint32_t *channels);

}  // namespace lensprof
