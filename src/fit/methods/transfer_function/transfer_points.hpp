// Points of the brightness transfer functions of all neighbours and channels: what the equations of the response are
// made of.
#pragma once

#include "fit/problem/problem.hpp"

namespace lensprof {

// B1 and B2 of one scene point, levels of 255, and how many pairs stand behind it.
struct TransferPoint {
    double level[2];
    double pairs;
};

struct TransferCurve {
    size_t edge;
    int channel;
    double noise = 0.0;  // of one grey value about the curve, levels; 0 = not known
    std::vector<TransferPoint> points;
};

// The curves of every edge and channel, in both directions, after the falloff of the estimate has been evened out
// between the two ends of each pair. `as_paper`: the points (I, T(I)) of the paths themselves; otherwise the mean of
// the pairs around each of their levels.
std::vector<TransferCurve> transfer_curves(const Problem &problem, const Estimate &estimate, bool as_paper);

}  // namespace lensprof
