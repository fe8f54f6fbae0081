// Patterns of the residuals over the frame that no response and radial falloff can explain.
//
// The residual of a pair is explained as h_i(p1) - h_j(p2) by piecewise constant maps h over the frame: one map for all
// images (the lens is not radial), or one per image (the picture was processed by its surroundings, or light
// changed). If maps from one half of the pairs explain a share of the variance in the other half, it is not chance.
#pragma once

#include <vector>

#include "fit/problem/problem.hpp"

namespace lensprof {

struct PatternShares {
    double frame = 0.0;  // one map for all images
    double image = 0.0;  // one per image, beyond the common one
};

// residual: signed, of every pair of the problem. Outliers are ignored.
PatternShares pattern_shares(const Problem &problem, const std::vector<double> &residual,
                             const std::vector<bool> &is_inlier);

}  // namespace lensprof
