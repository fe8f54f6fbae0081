// Pairs of any number of pictures of one scene from a stationary camera, with bounded memory and time.
#pragma once

#include <vector>

#include "photo/scene/sampling.hpp"

namespace lensprof {

// Pictures in memory at the same time. Fewer are sampled together, as sample_still does it.
constexpr uint32_t sweep_in_memory = 24;

struct SweepPairs {
    std::vector<lensprof_pair> pairs;
    uint32_t channels = 1;
    double load_s = 0.0, sample_s = 0.0;
};

// More pictures are read twice. The first time their brightness is measured; those that are all black or all white are
// left out. Then they are sampled in groups, each of which spans all brightnesses: neighbours in a sweep of small steps
// are almost equal, and show the response less than pictures far apart do. Eight pictures are in all groups and connect
// them. The pairs are `options.pairs`, or 10000 per picture; of more pictures 100000, but at least 100 per picture.
// Black as for sample_still.
SweepPairs sample_sweep(const Scene &scene, uint32_t max_side, lensprof_sample_options options, double black,
                        Events &progress);

}  // namespace lensprof
