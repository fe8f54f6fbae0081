// Start values: for a given response, the exposures that follow from the ratios of grey values on which most pairs of
// two images agree.
#pragma once

#include "fit/problem/problem.hpp"

namespace lensprof {

// The curves from which a fit with unknown response starts, each projected on `modes` EMoR modes: the mean of the
// model, a linear sensor, a gamma curve and a strongly compressed one. The transfer error has a local optimum for each
// kind.
std::vector<Estimate> start_estimates(const Problem &problem, const lensprof_fit_options &options, int modes);

// Sets the free exposures of an estimate whose response and vignetting are set. `width`: the largest difference between
// the logarithms of the ratios of pairs that agree; it is larger if the response is only a guess.
constexpr double kRoughWidth = 0.3, kFineWidth = 0.1;
void start_exposures(const Problem &problem, double width, Estimate &estimate);

}  // namespace lensprof
