// Standard errors of an estimator that has no formula for them: its scatter if a part of the pairs is left out
// (delete-a-group jackknife).
#pragma once

#include <functional>

#include "fit/solver/solver.hpp"

namespace lensprof {

constexpr uint32_t kJackknifeGroups = 20;  // a standard error then has a relative error of a sixth

// `without(keep)` returns the estimate from the pairs with these numbers, comparable to that of all pairs; it is called
// on several threads. The result is the scatter of the `modes` of the response, of the falloff and of the images'
// unknowns. Not determined if any call fails (no log exposures).
Covariance jackknife(const Problem &problem, uint32_t pair_count,
                     const std::function<Estimate(const std::vector<uint32_t> &keep)> &without,
                     const std::function<bool()> &cancelled);

}  // namespace lensprof
