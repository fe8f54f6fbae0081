// Prior knowledge as a quadratic cost: measured responses and lenses, and known exposures.
#pragma once

#include <Eigen/Core>

#include "fit/prior/falloff_prior.hpp"
#include "fit/problem/problem.hpp"

namespace lensprof {

// Standard deviation of each EMoR coefficient over the 201 curves of the DoRF database about the EMoR mean
// (profiles/tools/make_response_prior.py).
extern const double kEmorSigma[kMaxModes];

// Correlations of the same, below the diagonal, row by row.
extern const double kEmorCorrelation[kMaxModes * (kMaxModes - 1) / 2];

// The centre of a falloff is where the optical axis meets the sensor: mounting tolerances, in half diagonals.
constexpr double kCenterSigma = 0.02;

struct Prior {
    // Of the full shared vector: (s - mean)' precision (s - mean) / 2.
    Eigen::VectorXd mean;
    Eigen::MatrixXd precision;

    // Of u = ln M of green, per setting: (u - mean)' precision (u - mean) / 2, in addition to the above.
    std::vector<FalloffPrior> falloff;

    // Weight of the Gaussian prior on the EMoR coefficients with their full covariance (Goldman & Chen eq. 12), which
    // prior_of() adds to the precision. 0: the precision treats the coefficients as independent.
    double covariance_weight = 0.0;

    // The hold on the exponent gamma at its determined value (gauge.hpp): pin_precision (pin'emor - pin_value)^2 / 2.
    Eigen::VectorXd pin = Eigen::VectorXd::Zero(kMaxModes);
    double pin_value = 0.0, pin_precision = 0.0;

    // Known exposures: precision (a - log_exposure)^2 / 2 of the measured channel; may be empty.
    struct KnownExposure {
        double log_exposure = 0.0, precision = 0.0;
        double hold = 1.0;  // how much more firmly it is held than its standard error implies
    };
    std::vector<KnownExposure> known;
    bool renews_offset = false;  // whether any is held firmly relative to an offset that is renewed between rounds
};

// Response, falloff and centre of measured cameras and lenses, times `weight`; `by_covariance` as above.
Prior make_prior(double weight, int vignettings, int settings, bool by_covariance = false);

// What the images of a setting know of their lens: the mean of those that know it.
LensFacts facts_of(const Problem &problem, int setting);

// The knowledge of the lens at one setting, with weights relative to that of independent pairs (inflation.hpp).
struct LensKnowledge {
    FalloffPrior falloff;
    double falloff_weight = 1.0, center_weight = 1.0;
};
void set_lens(const LensKnowledge &lens, int vignettings, int setting, Prior &prior);

// Puts the prior on u of the first setting into mean and precision, linear about its mean.
void make_falloff_linear(int vignettings, Prior &prior);

// The prior if `modes` coefficients are estimated, without the contribution of the others.
Prior prior_of(const Prior &prior, int modes);

// Ties the falloff curves of a setting's channels to that of green, if there are three: adds to their precision.
void tie_channels(double weight, int vignettings, int setting, Prior &prior);

// Which of a setting's falloff curves is that of green: of one per channel the second, else the only one.
constexpr int green_curve(int vignettings) { return vignettings == 3 ? 1 : 0; }

// First column of green's k1..k3 in the full shared vector.
inline int green_falloff(int vignettings, int setting = 0) {
    return falloff_column(setting) + 3 * green_curve(vignettings);
}

// Covariance of the full shared vector of one setting over all measured cameras and lenses, with independent modes and
// the same falloff curve for all channels.
Eigen::MatrixXd scatter_of_all();

// The prior's share of the objective; of the shared unknowns only those in `columns`.
double prior_cost(const Prior &prior, const Problem &problem, const std::vector<int> &columns,
                  const Estimate &estimate);

}  // namespace lensprof
