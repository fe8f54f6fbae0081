// The prior on a falloff in normal equations, with numeric derivatives: independent of those of the solver.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "fit/prior/prior.hpp"

namespace lensprof {

// Adds the terms of ln M at r = .5, .75 and 1 of green, per setting, for the unknowns in `columns`.
inline void add_falloff_prior(const Problem &problem, const Estimate &estimate, const Prior &prior,
                              const std::vector<int> &columns, Eigen::MatrixXd &hessian, Eigen::VectorXd &gradient) {
    const double h = 1e-6, r2[3] = {0.25, 0.5625, 1.0};
    for (int s = 0; s < problem.settings; s++) {
        const int green = green_falloff(problem.vignettings, s);
        const Eigen::VectorXd full = shared_vector(estimate);
        const auto u_of = [&](const Eigen::VectorXd &at, int i) {
            const double r = r2[i];
            return std::log(1.0 + at[green] * r + at[green + 1] * r * r + at[green + 2] * r * r * r);
        };
        Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(3, gradient.size());
        Eigen::Vector3d off;
        for (int i = 0; i < 3; i++) {
            off[i] = u_of(full, i) - prior.falloff[static_cast<size_t>(s)].mean[i];
            for (size_t u = 0; u < columns.size(); u++) {
                Eigen::VectorXd up = full, down = full;
                up[columns[u]] += h, down[columns[u]] -= h;
                slope(i, static_cast<Eigen::Index>(u)) = (u_of(up, i) - u_of(down, i)) / (2 * h);
            }
        }
        const Eigen::Matrix3d &precision = prior.falloff[static_cast<size_t>(s)].precision;
        hessian += slope.transpose() * precision * slope;
        gradient -= slope.transpose() * precision * off;
    }
}

}  // namespace lensprof
