// The end of a fit, the same for all methods: the numbers of the result and its verdict.
#pragma once

#include <functional>

#include "fit/solver/solver.hpp"
#include "fit/verdict/result.hpp"

namespace lensprof {

// The findings of a method. The references only need to live during the call.
struct Found {
    const Problem &problem;  // all pairs
    const Gauge &gauge;
    const Estimate &estimate;  // of all pairs
    const Problem &tested;     // pairs that `train` has not seen; without such pairs (`has_heldout` false) all pairs
    const Estimate &train;
    bool has_heldout;
    double noise;  // sigma of a grey value, 0..1
    const Covariance &covariance;
    uint32_t iterations;
    bool converged;
};

// Fills the result except `profile_prior` and `seconds`, and the exposures. `judge_result` adds what only the method
// knows, after the common verdict.
void finish(const Found &found, const std::function<void(FitResult &)> &judge_result, lensprof_exposure *exposures,
            FitResult &result);

}  // namespace lensprof
