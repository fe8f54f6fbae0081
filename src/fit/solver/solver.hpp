// Levenberg-Marquardt with the images' unknowns eliminated and the shared step constrained.
#pragma once

#include <functional>
#include <vector>

#include "fit/base/parallel.hpp"
#include "fit/prior/gauge.hpp"
#include "fit/prior/prior.hpp"
#include "fit/problem/loss.hpp"
#include "fit/problem/problem.hpp"

namespace lensprof {

struct Control {
    int max_iterations = 200;
    int rounds = 6;
    double flat = 1e-3;  // a round ends when a step gains less: half of chi-squared, 1/20 sigma of one parameter
    std::function<bool()> cancelled;  // asked once an iteration
};

struct Outcome {
    double cost = 0.0;  // objective at the last noise weights
    int iterations = 0;
    bool converged = false;
};

// Largest change of what a user sees: grey value of the response, falloff, log exposure.
double largest_change(const Estimate &a, const Estimate &b);

// Improves `estimate` (feasible, `modes` modes) until it no longer moves. Between rounds the noise weights and what is
// known of gamma and exposures are renewed, and with `refine_noise` in the first rounds the noise level too
// (loss.noise): every round minimises one fixed objective.
Outcome solve(const Problem &problem, const Prior &prior, Gauge &gauge, Loss &loss, bool refine_noise,
              const Control &control, Estimate &estimate);

// Covariances at an estimate, gamma held: inverse of the Hessian of all unknowns.
struct Covariance {
    bool is_determined = false;
    Eigen::MatrixXd shared;  // full shared vector; zero rows where a parameter was held fixed
    Eigen::VectorXd images;  // variances of the images' unknowns
};
Covariance covariance(const Problem &problem, const Prior &prior, Gauge &gauge, const Loss &loss,
                      const Estimate &estimate);

}  // namespace lensprof
