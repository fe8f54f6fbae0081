// Known exposures from neighbour to neighbour: how much they scatter, and which of them agree.
//
// Errors of the fitted exposures add up along a row of pictures; those of known ones do not. Differences between
// neighbours - images that the most pairs join - tell the two apart: a known exposure that jumps away from both sides
// is wrong, and one from which all others are away by the same is where something changed unnoticed.
#pragma once

#include <cstdint>
#include <vector>

#include "fit/problem/problem.hpp"

namespace lensprof {

// Standard deviation by the median of absolute distances, in standard errors, which so many parameters were fitted to,
// less what may be chance; 1 where there is no more.
double scatter_of(std::vector<double> distances, size_t parameters);

class KnownNeighbours {
public:
    // `is_known`: of each image. The tree is that of the most pairs, over all images of the reference's group.
    KnownNeighbours(const Problem &problem, const std::vector<bool> &is_known);

    // Of the differences between neighbours. `off` and `sigma`: distance of each known exposure from the found one, and
    // its standard error. Infinity where there are too few.
    double scatter(const std::vector<double> &off, const std::vector<double> &sigma) const;

    // Of each image the level that it is on, from 0 in the order of their first images; -1 where not known. An image is
    // on that of the nearest of its neighbours that it agrees with, `scatter` times the standard errors.
    std::vector<int> levels(const std::vector<double> &off, const std::vector<double> &sigma, double scatter) const;

private:
    struct Visit {
        uint32_t image;
        int before;  // the nearest visit on the way from the start; -1: none
    };
    std::vector<Visit> visits_;  // of known images, neighbours after those they are reached from
};

}  // namespace lensprof
