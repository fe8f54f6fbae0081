// The quality of a result: residuals, covariance and coverage.
#pragma once

#include "fit/base/quantile.hpp"
#include "fit/solver/solver.hpp"
#include "fit/verdict/result.hpp"

namespace lensprof {

// Root mean square and median absolute value of transfer residuals, levels of 255.
struct Summary {
    double rms = 0.0, median = 0.0;
};
Summary summarise(std::vector<double> values);

// Absolute transfer residuals of all pairs, channels and directions, levels of 255.
std::vector<double> residual_levels(const Problem &problem, const Estimate &estimate);

// Fills the response and the numbers of pairs and falloff curves.
void describe_model(const Problem &problem, const Estimate &estimate, FitResult &result);

// Fills the residuals of pairs that the estimate has not seen; without such pairs, only their differences before
// correction.
void describe_heldout(const Problem &tested, const Estimate &train, bool is_heldout, FitResult &result);

// Fills noise (from that of a grey value, 0..1), inlier share, patterns, coverage of the grey values and the images'
// quality.
void describe_quality(const Problem &problem, const Gauge &gauge, double noise, const Covariance &found,
                      const Estimate &estimate, FitResult &result);

// Fills the fields of one lens setting: vignetting, covariance and coverage of the frame.
void describe_setting(const Problem &problem, const Gauge &gauge, const Covariance &found, const Estimate &estimate,
                      int setting, FitResult &result);

// Root mean square difference, EV, of overlapping pictures, over pairs and channels.
double exposure_spread(const Problem &problem, const Estimate &estimate);

// The same for the light at the two ends of a pair, falloff included.
double light_spread(const Problem &problem, const Estimate &estimate);

// Writes the exposures of all images, as far as they were free.
void write_exposures(const Problem &problem, const Estimate &estimate, lensprof_exposure *exposures);

// Images, joined to the reference, whose exposures are supported by fewer pairs than could agree by chance. Images that
// share an exposure count together; so do those that are held, including the reference.
struct FewInliers {
    uint32_t image, inliers;
};
std::vector<FewInliers> images_with_few_inliers(const Problem &problem, const FitResult &result);

// Standard error, EV, that the pairs alone leave to an image's exposure: without that of gamma. `ev`: its exposure
// relative to the reference.
double ev_sigma_of_pairs(const FitResult &result, uint32_t image, double ev);

}  // namespace lensprof
