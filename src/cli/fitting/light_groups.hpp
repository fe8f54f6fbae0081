// Pictures of one place in different light: whether the images of a result fall into such groups.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "cli/fitting/fitting.hpp"

namespace lensprof {

// Two groups of images whose colours agree within each and not between them.
struct LightGroups {
    double ratio = 1.0;            // how much more colours differ between the groups than within: of variances
    std::vector<uint32_t> second;  // images of the smaller group; empty: there is one light
};

// By the links of the minimum spanning tree of the images, a link weighing the median difference of its pairs
// (colour_differences): where the light differs, a group is joined to the rest by links that are all as bad, also
// between views that are as near to each other (`view_distances`) as those within. Groups of fewer than three images
// are not told from pictures that are off.
LightGroups light_groups(const FitInput &input, const std::vector<double> &differences,
                         const std::map<std::pair<uint32_t, uint32_t>, double> &view_distances);

}  // namespace lensprof
