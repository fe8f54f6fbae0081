// The shared step as a constrained least squares problem: what keeps the response rising and the falloff positive.
#pragma once

#include <Eigen/Core>

#include "fit/problem/problem.hpp"

namespace lensprof {

// Smallest increase of f between two of its 1024 samples, 1/1000 of the mean increase: strictly invertible.
constexpr double kSmallestRise = 1e-6;

// True when f rises by at least half of kSmallestRise everywhere and every M is positive wherever a frame can reach.
bool is_feasible(const Estimate &estimate, int vignettings);

// A feasible region in the free shared unknowns. columns[u] is the index of unknown u in the full shared vector;
// `value` is the full vector at which steps start, itself feasible.
struct Region {
    int modes;
    int vignettings;
    std::vector<int> columns;
    Eigen::VectorXd value;
};

// Minimises  1/2 d'Sd - b'd  over steps d that stay in the region, as constrained_step of inequality.hpp does.
Eigen::VectorXd constrained_step(const Region &region, const Eigen::MatrixXd &S, const Eigen::VectorXd &b);

// The monotone member of the first `modes` modes nearest to a curve of 1024 samples.
std::vector<double> project_curve(const double *curve, int modes);

}  // namespace lensprof
