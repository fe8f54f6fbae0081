// Standard errors of an estimator that no formula describes: how it scatters where a part of the pairs is left out
// (delete-a-group jackknife).
#pragma once

#include <functional>

#include "fit/solver/solver.hpp"

namespace lensprof {

constexpr uint32_t kJackknifeGroups = 20;  // a standard error is then itself known to a sixth

// `without(keep)` is the estimate from the pairs of these numbers, to be compared with that of all; called on several
// threads. What is told of the `modes` of the response, the falloff's and the images' unknowns is the scatter of these.
// Not determined where any of them failed (no log exposures).
Covariance jackknife(const Problem &problem, uint32_t pair_count,
                     const std::function<Estimate(const std::vector<uint32_t> &keep)> &without,
                     const std::function<bool()> &cancelled);

}  // namespace lensprof
