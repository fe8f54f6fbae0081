// Rings of the frame, and functions of r^2 that are linear between their ends.
#pragma once

#include <algorithm>

#include <Eigen/Core>

#include <lensprof/trial.h>

namespace lensprof {

constexpr int kRings = LENSPROF_TRIAL_RINGS;
constexpr double kEnds[kRings] = {0.25, 0.5, 0.7, 0.85, 1.0};  // largest r of each, half diagonals
using RingVector = Eigen::Matrix<double, kRings, 1>;
using RingMatrix = Eigen::Matrix<double, kRings, kRings>;

// The weight of each node of d at r^2: nodes are the ends of rings.
inline RingVector node_weights(double r2) {
    RingVector weights = RingVector::Zero();
    double low = 0.0;
    for (int n = 0; n < kRings; n++) {
        const double high = kEnds[n] * kEnds[n];
        if (r2 <= high || n == kRings - 1) {
            const double share = std::min((r2 - low) / (high - low), 1.0);
            weights[n] = share;
            if (n > 0) weights[n - 1] = 1.0 - share;
            return weights;
        }
        low = high;
    }
    return weights;
}

inline int ring_of(double r2) {
    int ring = 0;
    while (ring < kRings - 1 && r2 > kEnds[ring] * kEnds[ring]) ring++;
    return ring;
}

// Square of the distance from the middle of the frame, half diagonals.
inline double r2_of(const lensprof_fit_image &image, double x, double y) {
    const double dx = x - 0.5 * (image.width - 1.0), dy = y - 0.5 * (image.height - 1.0);
    const double rho = lensprof_half_diagonal(image.width, image.height);
    return (dx * dx + dy * dy) / (rho * rho);
}

}  // namespace lensprof
