// Descent of a sum of squares whose unknowns are few, without constraints but for places that are refused.
//
// About a place with the gradient -g and the Gauss-Newton Hessian H of the objective, a step d solves
//     (H + lambda diag(H)) d = g.
// The damping lambda (Marquardt 1963) turns the step from Newton's towards the steepest descent in the unknowns' own
// units; it falls by ten after a step that helps, and grows by ten after one that does not.
//
// The overlap fit has a loop of its own (fit/solver): its images are eliminated, the step keeps inequalities, and a
// place costs so much that the model of the accepted one is kept and values alone are tried after a failure.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "falloff/dense.hpp"

namespace lensprof {

// The objective's quadratic model at a place; `gradient` is that of -objective.
struct QuadraticModel {
    Eigen::MatrixXd hessian;
    Eigen::VectorXd gradient;
    double objective = 0.0;
};

struct DescentLimits {
    int steps;             // most accepted ones
    double first_damping;  // larger where the start is poor
    double damping;        // beyond, nothing more is to be gained
    double gain;           // share of the objective at which a descent has converged
};

struct Descent {
    int steps = 0;
    bool converged = false;
};

// model() is the QuadraticModel at the present place, objective_after(d) the objective at the place plus d (INFINITY
// where that is refused), accept(d) moves there.
template <class Model, class ObjectiveAfter, class Accept>
Descent levenberg_marquardt(const DescentLimits &limits, Model model, ObjectiveAfter objective_after, Accept accept) {
    Descent descent;
    double damping = limits.first_damping;
    for (; descent.steps < limits.steps && !descent.converged && damping < limits.damping; descent.steps++) {
        const QuadraticModel current = model();
        bool better = false;
        for (; !better && damping < limits.damping; damping *= better ? 0.1 : 10.0) {
            Eigen::MatrixXd damped = current.hessian;
            damped.diagonal() *= 1.0 + damping;
            damped.diagonal().array() += 1e-12;  // an unknown that nothing depends on stays
            const Eigen::VectorXd change = solve_symmetric(damped, current.gradient);
            const double gain = current.objective - objective_after(change);
            better = gain >= 0.0;
            if (!better && std::abs(gain) > limits.gain * current.objective) continue;
            if (better) accept(change);
            descent.converged = gain <= limits.gain * current.objective;
            if (descent.converged) break;
        }
    }
    return descent;
}

}  // namespace lensprof
