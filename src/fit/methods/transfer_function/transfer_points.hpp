// Points of the brightness transfer functions of all neighbours and channels: the input of the response's equations.
#pragma once

#include "fit/problem/problem.hpp"

namespace lensprof {

// B1 and B2 of one scene point, levels of 255, and how many pairs support it.
struct TransferPoint {
    double level[2];
    double pairs;
};

struct TransferCurve {
    size_t edge;
    int channel;
    double noise = 0.0;  // of one grey value about the curve, levels; 0 = unknown
    std::vector<TransferPoint> points;
};

// The curves of every edge and channel, in both directions, after compensating the falloff of the estimate between the
// two ends of each pair. `as_paper`: the points (I, T(I)) of the paths themselves; otherwise the mean of the pairs
// around each of their levels.
std::vector<TransferCurve> transfer_curves(const Problem &problem, const Estimate &estimate, bool as_paper);

}  // namespace lensprof
