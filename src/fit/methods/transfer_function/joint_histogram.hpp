// The joint histogram of two images' grey levels, and the most likely brightness transfer function through it (Kim &
// Pollefeys 2004, section 2.2).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lensprof {

// Grey values of one scene point in two images, levels of 255 with fraction.
using LevelPair = std::array<double, 2>;

// count[b1 * bins + b2]: pairs, each in the bin nearest to it; bin b stands for level 255 b / (bins - 1).
struct JointHistogram {
    int bins;
    std::vector<double> count;

    double at(int b1, int b2) const { return count[static_cast<size_t>(b1 * bins + b2)]; }
    double level(double bin) const { return 255.0 * bin / (bins - 1); }
    double bin(double level) const { return level * (bins - 1) / 255.0; }
};

JointHistogram joint_histogram(const std::vector<LevelPair> &pairs, int bins);

// ln( G(0, sigma) * J + P0 ), eq. 5: sigma in bins, P0 what as many pairs would give that lie evenly over all bins.
JointHistogram log_likelihood(const JointHistogram &histogram, double sigma);

JointHistogram transposed(const JointHistogram &histogram);

// The path b2 = T(b1) of the greatest sum of logarithms (eq. 6) that does not fall, with T(0) = 0, T(max) = max, and
// T >= identity everywhere or T <= identity everywhere, whichever is the likelier.
struct TransferPath {
    std::vector<int> to;
    double log_likelihood;
};
TransferPath most_likely_path(const JointHistogram &log_likelihood);

}  // namespace lensprof
