// The joint histogram of two images' grey levels, and the most likely brightness transfer function through it (Kim &
// Pollefeys 2004, section 2.2).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lensprof {

// Grey values of one scene point in two images, levels of 255 with fraction.
using LevelPair = std::array<double, 2>;

// count[b1 * bins + b2]: number of pairs, each in its nearest bin; bin b represents level 255 b / (bins - 1).
struct JointHistogram {
    int bins;
    std::vector<double> count;

    double at(int b1, int b2) const { return count[static_cast<size_t>(b1 * bins + b2)]; }
    double level(double bin) const { return 255.0 * bin / (bins - 1); }
    double bin(double level) const { return level * (bins - 1) / 255.0; }
};

JointHistogram joint_histogram(const std::vector<LevelPair> &pairs, int bins);

// ln( G(0, sigma) * J + P0 ), eq. 5: sigma in bins; P0 is the value if as many pairs were spread evenly over all bins.
JointHistogram log_likelihood(const JointHistogram &histogram, double sigma);

JointHistogram transposed(const JointHistogram &histogram);

// The non-decreasing path b2 = T(b1) with the greatest sum of logarithms (eq. 6), with T(0) = 0, T(max) = max, and
// either T >= identity everywhere or T <= identity everywhere, whichever is likelier.
struct TransferPath {
    std::vector<int> to;
    double log_likelihood;
};
TransferPath most_likely_path(const JointHistogram &log_likelihood);

}  // namespace lensprof
