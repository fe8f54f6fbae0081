// Images of one scene, taken at two visits in different light.
#pragma once

#include <vector>

#include "fit/scene/scene.hpp"

namespace lensprof {

struct Visits {
    double ratio = 1.0;            // of colour variances between the groups and within
    std::vector<uint32_t> second;  // images of the smaller group; empty: only one light
};

// Uses the minimum spanning tree of the images, with the median colour difference of a link's pairs as its weight: if
// the light differs, all links that connect a group to the rest are equally bad, even between views as close as those
// within a group. Groups of fewer than three images cannot be distinguished from outliers.
Visits find_visits(uint32_t image_count, const SceneData &data, const std::vector<double> &differences);

}  // namespace lensprof
