// Robust least squares of differences, in levels: large residuals lose their weight in steps, so that nearly half of
// the differences may be wrong if the others agree.
#pragma once

#include <algorithm>
#include <vector>

#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"

namespace lensprof {

constexpr double kMinScale = 0.3;     // levels: quantisation alone causes as much
constexpr double kFirstLimit = 40.0;  // in scales: nearly all differences count
constexpr double kLastLimit = 3.0;    // larger differences get little weight
constexpr double kLimitFactor = 0.7;  // per iteration
constexpr int kRoundsAtLastLimit = 6;

// Weight of a residual, relative to that of zero (Geman and McClure); beyond `end` it is little.
inline double robust_weight(double residual, double end) {
    const double off = 1.0 + residual * residual / (end * end);
    return 1.0 / (off * off);
}

// solve(residuals, scale, end) gives the absolute residuals, levels, of the solution with weights for the given ones;
// initially these are zero, and all differences count equally.
template <class Solve>
void solve_robustly(size_t differences, Solve solve) {
    std::vector<double> residuals(differences, 0.0);
    double limit = kFirstLimit;
    for (int rounds_at_last = 0; rounds_at_last < kRoundsAtLastLimit;) {
        const double scale = std::max(kMinScale, kMadToSigma * upper_median(residuals));
        residuals = solve(residuals, scale, limit * scale);
        limit = std::max(kLastLimit, kLimitFactor * limit);
        rounds_at_last += limit == kLastLimit;
    }
}

}  // namespace lensprof
