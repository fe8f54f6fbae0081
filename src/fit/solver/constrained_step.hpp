// The shared step as a constrained least squares problem: what keeps the response rising and the falloff positive.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace lensprof {

// A feasible region in the free shared unknowns. columns[u] is the index of unknown u in the full shared vector;
// `value` is the full vector at which steps start, itself feasible.
struct Region {
    int modes;
    int vignettings, settings;
    std::vector<int> columns;
    Eigen::VectorXd value;
    bool falls = false;  // whether no falloff may rise outward, within a half diagonal
};

// Minimises  1/2 d'Sd - b'd  over steps d that stay in the region, as constrained_step of inequality.hpp does.
Eigen::VectorXd constrained_step(const Region &region, const Eigen::MatrixXd &S, const Eigen::VectorXd &b);

}  // namespace lensprof
