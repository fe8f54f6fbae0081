// Known exposures from neighbour to neighbour: how much they scatter, and which of them agree.
//
// Errors of the fitted exposures add up along a row of pictures; those of known ones do not. Differences
// between neighbours (images joined by the most pairs) distinguish the two. A known exposure that jumps away from both
// neighbours is wrong. If all exposures from one image on are off by the same amount, something changed unnoticed
// there.
#pragma once

#include <cstdint>
#include <vector>

#include "fit/problem/problem.hpp"

namespace lensprof {

// Robust standard deviation from the median of absolute distances, given in standard errors; `parameters` were fitted
// to them. Reduced by what may be chance; at least 1.
double scatter_of(std::vector<double> distances, size_t parameters);

class KnownNeighbours {
public:
    // `is_known`: per image. The tree is that of the most pairs, over all images of the reference's group.
    KnownNeighbours(const Problem &problem, const std::vector<bool> &is_known);

    // Scatter of the differences between neighbours. `off` and `sigma`: distance of each known exposure from the found
    // one, and its standard error. Infinity if there are too few.
    double scatter(const std::vector<double> &off, const std::vector<double> &sigma) const;

    // The level of each image, numbered from 0 in the order of their first images; -1 if not known. An image has the
    // level of the nearest neighbour that it agrees with, within `scatter` times the standard errors.
    std::vector<int> levels(const std::vector<double> &off, const std::vector<double> &sigma, double scatter) const;

private:
    struct Visit {
        uint32_t image;
        int before;  // the nearest visit on the way from the start, or -1
    };
    std::vector<Visit> visits_;  // of known images, each after the one it is reached from
};

}  // namespace lensprof
