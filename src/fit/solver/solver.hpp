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

struct Inflation;

struct Control {
    int max_iterations = 200;
    int rounds = 6;
    double flat = 1e-3;  // a round ends if a step gains less: half of chi-squared, 1/20 sigma of one parameter
    bool falls = false;  // whether no falloff may rise outward; the estimate to start from must not, either
    std::function<bool()> cancelled;  // called once per iteration
};

struct Outcome {
    double cost = 0.0;  // objective at the last noise weights
    int iterations = 0;
    bool converged = false;
};

// Largest change of a visible quantity: grey value of the response, falloff, log exposure.
double largest_change(const Estimate &a, const Estimate &b);

// Improves `estimate` (feasible, `modes` modes) until it converges. Every round minimises one fixed objective. Between
// rounds the noise weights and the knowledge of gamma and exposures are renewed and, with `refine_noise`, in the first
// rounds also the noise level (loss.noise).
Outcome solve(const Problem &problem, const Prior &prior, Gauge &gauge, Loss &loss, bool refine_noise,
              const Control &control, Estimate &estimate);

// Covariances at an estimate, gamma held: inverse of the Hessian of all unknowns, times the inflation of errors that
// neighbouring pairs share (NULL: independent pairs).
struct Covariance {
    bool is_determined = false;
    Eigen::MatrixXd shared;  // full shared vector; zero rows for parameters held fixed
    Eigen::VectorXd images;  // variances of the images' unknowns
};
Covariance covariance(const Problem &problem, const Prior &prior, Gauge &gauge, const Loss &loss,
                      const Estimate &estimate, const Inflation *inflation = nullptr);

}  // namespace lensprof
