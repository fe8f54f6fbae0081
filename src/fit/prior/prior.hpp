// What is known before the pairs are seen, as a quadratic cost: measured responses and lenses, and known exposures.
#pragma once

#include <Eigen/Core>

#include "fit/problem/problem.hpp"

namespace lensprof {

// Standard deviation of each EMoR coefficient over the 201 curves of the DoRF database about the EMoR mean
// (profiles/tools/make_response_prior.py).
extern const double kEmorSigma[kMaxModes];

// Correlations of the same, below the diagonal, row by row.
extern const double kEmorCorrelation[kMaxModes * (kMaxModes - 1) / 2];

struct Prior {
    // Of the full shared vector: (s - mean)' precision (s - mean) / 2.
    Eigen::VectorXd mean;
    Eigen::MatrixXd precision;

    // Weight of the Gaussian prior on the EMoR coefficients with their full covariance (Goldman & Chen eq. 12), which
    // prior_of() puts into the precision; 0: the coefficients are taken as independent there.
    double covariance_weight = 0.0;

    // The exponent gamma, held where it was settled (gauge.hpp): pin_precision (pin'emor - pin_value)^2 / 2.
    Eigen::VectorXd pin = Eigen::VectorXd::Zero(kMaxModes);
    double pin_value = 0.0, pin_precision = 0.0;

    // Known exposures: precision (a - log_exposure)^2 / 2 of the measured channel; empty where there are none.
    struct KnownExposure {
        double log_exposure = 0.0, precision = 0.0;
        double hold = 1.0;  // by how much it is held more firmly than its standard error says
    };
    std::vector<KnownExposure> known;
};

// Response and falloff of measured cameras and lenses, times `weight`, the same of every setting; `by_covariance` as
// above.
Prior make_prior(double weight, int vignettings, int settings, bool by_covariance = false);

// The prior where `modes` coefficients are estimated: what the others may be has no part in it.
Prior prior_of(const Prior &prior, int modes);

// Ties the falloff curves of a setting's channels to that of green, where there are three.
void tie_channels(double weight, int vignettings, int setting, Prior &prior);

// Column of the full shared vector where k1..k3 of green's falloff begin.
inline int green_falloff(int vignettings, int setting = 0) {
    return falloff_column(setting) + (vignettings == 3 ? 3 : 0);
}

// Covariance of the full shared vector of one setting over all measured cameras and lenses; modes as independent,
// curves of the channels alike.
Eigen::MatrixXd scatter_of_all();

// Its share of the objective; of the shared unknowns those in `columns` alone.
double prior_cost(const Prior &prior, const Problem &problem, const std::vector<int> &columns,
                  const Estimate &estimate);

}  // namespace lensprof
