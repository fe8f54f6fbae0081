// The objective that the solver minimises, depending on the problem's method.
#pragma once

#include <memory>

#include "fit/problem/loss.hpp"
#include "fit/solver/normal_equations.hpp"

namespace lensprof {

class Objective {
public:
    virtual ~Objective() = default;

    // The quadratic model about an estimate, and the value of the objective alone.
    virtual std::unique_ptr<NormalEquations> model_at(const Estimate &estimate) const = 0;
    virtual double value_at(const Estimate &estimate) const = 0;
};

// The objective with the quantities that are held while the solver steps (noise weights, trust) evaluated at an
// estimate. It keeps references to its arguments.
std::unique_ptr<Objective> make_objective(const Problem &problem, const Prior &prior, const Loss &loss,
                                          const Estimate &estimate);

// The cost of every pair, or every track, at an estimate.
std::vector<double> all_costs(const Problem &problem, const Loss &loss, const Estimate &estimate);

}  // namespace lensprof
