// The symmetric grey value transfer error of one pair and its exact derivatives.
//
//   forward   B1 - f( g(B2) t ),    backward   B2 - f( g(B1) / t ),
//   t = s1/s2 = exp(delta),  delta = ln M(p1) + a1 - ln M(p2) - a2              (d'Angelo eq. 5, 8 and section 3)
#pragma once

#include "problem.hpp"

namespace lensprof {

// Both residuals of one channel: [0] forward, [1] backward.
struct Transfer {
    double residual[2];
    double by_delta[2];   // d prediction / d delta
    double by_value[2];   // d prediction / d the other grey value: tau'
    double x[2], y[2];    // irradiances behind the two values, and arguments of f in the two predictions
    double slope_x[2], slope_y[2];
};

// ln M of a pair's two ends and their derivatives: by_k[n], by_center[0..1] of ln M(p1) - ln M(p2).
struct Falloff {
    double log_ratio;
    double by_k[3];
    double by_center[2];
};

Falloff falloff(const Problem &problem, const Estimate &estimate, const lensprof_pair &pair);

Transfer transfer(const Estimate &estimate, double value1, double value2, double delta);

// All channels of a pair, at an estimate.
struct PairTransfer {
    Falloff fall;
    std::array<Transfer, 3> channel;
};
PairTransfer evaluate_pair(const Problem &problem, const Estimate &estimate, const lensprof_pair &pair);

// d residual[side] / d emor[l] for l < modes (the negative of the prediction's).
void transfer_by_emor(const Estimate &estimate, const Transfer &t, int side, double *by_emor);

}  // namespace lensprof
