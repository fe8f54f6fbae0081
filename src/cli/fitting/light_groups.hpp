// Detects whether the images of a result fall into groups that show the scene in different light.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "cli/fitting/fitting.hpp"

namespace lensprof {

// Two groups of images whose colours agree within each group but not between the groups.
struct LightGroups {
    double ratio = 1.0;            // ratio of colour variances between groups and within
    std::vector<uint32_t> second;  // images of the smaller group; empty: only one light
};

// Uses the minimum spanning tree of the images, with the median difference of a link's pairs (colour_differences) as
// its weight: if the light differs, all links that connect a group to the rest are equally bad, even between views as
// close (`view_distances`) as those within a group. Groups of fewer than three images cannot be distinguished from
// outliers.
LightGroups light_groups(const FitInput &input, const std::vector<double> &differences,
                         const std::map<std::pair<uint32_t, uint32_t>, double> &view_distances);

}  // namespace lensprof
