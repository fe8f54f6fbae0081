// Samples pairs at the matches of a reconstruction whose pictures may not fit in memory together.
#pragma once

#include <vector>

#include "photo/scene/scene.hpp"

namespace lensprof {

// Maximum bytes of the pictures of a block.
constexpr uint64_t default_block_bytes = uint64_t(512) << 20;

// Measures pairs at the project's matches, for two blocks of pictures at a time: images that share matches are in few
// blocks, so every picture is read only a few times. `links` receives the links of the images, `points` the scene point
// per pair. options.pairs: 0 = one per match. *channels receives 3, or 1 if all pictures are grey.
std::vector<lensprof_pair> sample_in_blocks(const Scene &scene, const lensprof_sample_options &options,
                                            uint32_t max_side, uint64_t block_bytes, Events &progress,
                                            std::vector<lensprof_link> &links, std::vector<uint32_t> &points,
                                            uint32_t *channels);

}  // namespace lensprof
