// What a result is worth: residuals, covariance, coverage, and in plain words why it is not usable.
#pragma once

#include "solver.hpp"

namespace lensprof {

// Value at a share 0..1 of the values in order, which change places; 0 of none.
double quantile(std::vector<double> &values, double share);

// Root mean square and median absolute value of transfer residuals, levels of 255.
struct Summary {
    double rms = 0.0, median = 0.0;
};
Summary summarise(std::vector<double> values);

// Absolute transfer residuals of all pairs, channels and directions, levels of 255.
std::vector<double> residual_levels(const Problem &problem, const Estimate &estimate);

// Fills noise, inlier share, patterns, covariance, coverage and the images' quality.
void describe_quality(const Problem &problem, const Prior &prior, Gauge &gauge, const Loss &loss,
                      const Estimate &estimate, lensprof_fit_result &result);

// Fills `usable` and `reason` from everything else.
void judge(const Problem &problem, const Estimate &estimate, lensprof_fit_result &result);

}  // namespace lensprof
