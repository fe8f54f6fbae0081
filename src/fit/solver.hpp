// Levenberg-Marquardt with the images' unknowns eliminated and the shared step constrained.
#pragma once

#include <functional>
#include <vector>

#include "loss.hpp"
#include "prior.hpp"
#include "problem.hpp"

namespace lensprof {

struct Control {
    int max_iterations = 200;
    std::function<bool()> cancelled;  // asked once an iteration
};

struct Outcome {
    double cost = 0.0;     // objective at the last noise weights
    int iterations = 0;
    bool converged = false;
};

struct Cancelled {};

// Improves `estimate` (feasible, `modes` modes) until it no longer moves. Between rounds the noise weights are renewed,
// and with `refine_noise` in the first rounds the noise level too (loss.noise): every round minimises one fixed
// objective.
Outcome solve(const Problem &problem, const Prior &prior, Loss &loss, bool refine_noise, const Control &control,
              Estimate &estimate);

// Covariance of the full shared vector (emor[0..24], k1..k3, centre): inverse of the reduced Hessian at the estimate,
// with the images' unknowns free. Zero rows where a parameter was held fixed; all zero where the data do not determine
// it.
Eigen::MatrixXd shared_covariance(const Problem &problem, const Prior &prior, const Loss &loss,
                                  const Estimate &estimate);

}  // namespace lensprof
