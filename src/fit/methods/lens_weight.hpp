// How much the knowledge of lenses weighs against what pictures show of a lens.
#pragma once

#include <vector>

#include "fit/prior/prior.hpp"
#include "fit/solver/inflation.hpp"
#include "fit/solver/solver.hpp"

namespace lensprof {

// The knowledge of one setting's lens, and how far the pictures alone are from it, in combined standard errors.
struct WeighedLens {
    LensKnowledge knowledge;
    double falloff_distance = 0.0, center_distance = 0.0;
};

// For every setting, from an estimate made with `prior`. The information of the pictures alone is that of the estimate
// less that of the prior, divided by the inflation of its errors. `weight`: of all priors.
std::vector<WeighedLens> weigh_lenses(const Problem &problem, const Prior &prior, double weight,
                                      const Estimate &estimate, const Covariance &found, const Inflation &inflation);

}  // namespace lensprof
