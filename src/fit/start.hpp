// Start values: for a given response, the exposures that follow from the median grey value ratios of each image pair.
#pragma once

#include "problem.hpp"

namespace lensprof {

// The curves from which a fit with unknown response starts, each projected on `modes` EMoR modes: the mean of the
// model, a linear sensor, a gamma curve and a strongly compressed one. The transfer error has a local optimum for each
// kind.
std::vector<Estimate> start_estimates(const Problem &problem, const lensprof_fit_options &options, int modes);

// Sets the free exposures of an estimate whose response and vignetting are set.
void start_exposures(const Problem &problem, Estimate &estimate);

}  // namespace lensprof
