// What the solver minimises, by the problem's method.
#pragma once

#include <memory>

#include "fit/problem/loss.hpp"
#include "fit/solver/normal_equations.hpp"

namespace lensprof {

class Objective {
public:
    virtual ~Objective() = default;

    // The quadratic model about an estimate, and the objective's value there alone.
    virtual std::unique_ptr<NormalEquations> model_at(const Estimate &estimate) const = 0;
    virtual double value_at(const Estimate &estimate) const = 0;
};

// The objective with what is held while the solver steps (noise weights, trust) as it is at an estimate. It keeps
// references to what it is made of.
std::unique_ptr<Objective> make_objective(const Problem &problem, const Prior &prior, const Loss &loss,
                                          const Estimate &estimate);

// What every pair, or every track, costs at an estimate.
std::vector<double> all_costs(const Problem &problem, const Loss &loss, const Estimate &estimate);

}  // namespace lensprof
