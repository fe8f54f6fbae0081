// Gaussian priors on the shared unknowns, measured from data. They decide what pictures leave open (the exponent gamma,
// unseen radii and grey levels) and weigh nothing where pairs are plenty.
#pragma once

#include <Eigen/Core>

#include "problem.hpp"

namespace lensprof {

// Standard deviation of each EMoR coefficient over the 201 curves of the DoRF database about the EMoR mean
// (profiles/tools/make_response_prior.py).
extern const double kEmorSigma[kMaxModes];

// Mean and precision of the full shared vector (emor[0..24], k1..k3, centre x, y), times `weight`.
//
// The prior on the response grows with the number of pairs, as if it were one more pair in every 200. Pictures say
// nothing about the exponent gamma, but a basis of few modes does: it represents some members of a curve's gamma family
// better than others, and that preference grows with the pairs. The prior has to keep up with it. What pictures do
// determine they determine a hundredfold better, so that it is not disturbed.
struct Prior {
    Eigen::VectorXd mean;
    Eigen::MatrixXd precision;
};
Prior make_prior(double weight, size_t pairs);

}  // namespace lensprof
