// The cost of a residual.
//
// SQUARED and HUBER take every residual as it is, in grey values (d'Angelo eq. 10 and 11). ROBUST weighs a residual by
// the noise it carries: a noise of sigma in both grey values puts sigma sqrt(1 + tau'^2) into B1 - tau(B2), and the two
// directions are then the same measurement twice. A pair's residuals of all channels form z, chi-squared with
// one degree of freedom per channel; the pair is trusted or distrusted as a whole by
//     rho(z) = c^2 atan(z / c^2),    weight rho'(z) = 1 / (1 + (z / c^2)^2),
// quadratic for noise and bounded for outliers.
#pragma once

#include <array>
#include <vector>

#include "fit/problem/problem.hpp"
#include "fit/problem/residual.hpp"

namespace lensprof {

struct Loss {
    uint32_t kind = LENSPROF_LOSS_ROBUST;
    double huber = 5.0 / 255.0;  // HUBER: sigma, grey value 0..1
    double noise = 2.0 / 255.0;  // sigma of one grey value
    double cutoff = 4.0;         // ROBUST: c, in sigmas of a pair's typical size
    bool distrusts = false;      // ROBUST: can leave out single observations of a track (radiance.hpp)
};

// 1 / sqrt(1 + tau'^2) of every pair, [channel][direction], at one estimate; 1 for the unweighted losses. Held constant
// while the solver steps, so that cost and Jacobian are consistent.
using PairWeights = std::array<std::array<float, 2>, 3>;
using NoiseWeights = std::vector<PairWeights>;
PairWeights pair_weights(const PairTransfer &transfer, int channels, const Loss &loss);
NoiseWeights noise_weights(const Problem &problem, const Estimate &estimate, const Loss &loss);

// Residuals of all channels of a pair, [channel][direction], multiplied by their noise weights.
using PairResiduals = std::array<std::array<double, 2>, 3>;
PairResiduals weighted_residuals(const PairTransfer &transfer, int channels, const PairWeights &weights);

// The pair's z in units of the noise variance (chi-squared, one degree of freedom per channel).
double pair_chi2(const PairResiduals &residuals, int channels, double noise);

// rho(z) of the robust loss for a cut-off c^2; *divisor receives 1 / rho'(z).
double robust_cost(double z, double c2, double *divisor);

// The pair's share of the objective, and the factor of each squared residual in its quadratic model.
double pair_cost(const PairResiduals &residuals, int channels, const Loss &loss, PairResiduals *weights);

// z of every pair at an estimate, in units of a noise level (grey value 0..1).
std::vector<double> all_chi2(const Problem &problem, const Estimate &estimate, double noise);

// The z below which a pair counts as an inlier: 99.7 % of the chi-squared distribution (3 sigma).
double inlier_limit(int channels);

// Noise of one grey value from the residuals of all pairs, robust against more than half outliers.
double estimate_noise(const Problem &problem, const Estimate &estimate, double start);

}  // namespace lensprof
