// What residuals show that no response and radial falloff can: patterns over the frame.
//
// The residual of a pair is explained as h_i(p1) - h_j(p2) by piecewise constant maps h over the frame: one map for all
// images (the lens is not radial), or one for each image (the picture was processed by its surroundings, or light
// changed). The share of the variance that maps from one half of the pairs explain in the other half is no chance.
#pragma once

#include <vector>

#include "fit/problem/problem.hpp"

namespace lensprof {

struct PatternShares {
    double frame = 0.0;  // one map for all images
    double image = 0.0;  // one for each, beyond that
};

// residual: signed, of every pair of the problem. Pairs that are not inliers do not take part.
PatternShares pattern_shares(const Problem &problem, const std::vector<double> &residual,
                             const std::vector<bool> &is_inlier);

}  // namespace lensprof
