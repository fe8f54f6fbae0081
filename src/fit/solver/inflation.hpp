// How far the errors of pairs that lie together exceed those of independent pairs.
//
// Registration, parallax, haze and a response that the modes do not follow give neighbouring pairs a common error. The
// variance of an estimate is then that of independent pairs times an inflation (in surveys, the design effect; a
// covariance clustered by places, Liang & Zeger 1986):
//
//     sum over places (sum of the influences of its pairs)^2  /  sum over pairs of influence^2,
//
// where the influence of a pair is its part in the error of the estimate. It is 1 for independent errors. Falloff and
// centre are small differences over large parts of the frame: they suffer most.
#pragma once

#include <vector>

#include "fit/prior/gauge.hpp"
#include "fit/problem/loss.hpp"

namespace lensprof {

// At least 1 each.
struct Inflation {
    double response = 1.0, exposures = 1.0;
    std::vector<double> lens;  // falloff and centre, per lens setting

    explicit Inflation(int settings) : lens(static_cast<size_t>(settings), 1.0) {}

    // Of a column of the full shared vector.
    double of_column(int column) const;
};

Inflation error_inflation(const Problem &problem, const Prior &prior, Gauge &gauge, const Loss &loss,
                          const Estimate &estimate);

}  // namespace lensprof
