// The response by its logarithmic inverse G = ln f^-1 at the grey levels 1..255 of 255, free at every level.
//
// Two grey values of one scene point obey  G(B1) - G(B2) = ln M1/M2 + a1 - a2  (Kim & Pollefeys 2004, eq. 3; Debevec &
// Malik 1997, eq. 2, with the radiance eliminated): linear in G and in the exposures. A smooth correction D = G - G0
// of the fitted curve G0 refines what an EMoR basis cannot represent, steep ends above all.
#pragma once

#include "fit/prior/gauge.hpp"
#include "fit/problem/loss.hpp"

namespace lensprof {

constexpr uint32_t kMaxRefinedImages = 256;  // their exposures are solved for densely

// Refines the response and the exposures of an estimate that has an EMoR response: its response becomes a table. `loss`
// provides the noise. gamma, which no pair determines, stays.
void refine_response(const Problem &problem, const Loss &loss, Estimate &estimate);

// Its parts, for tests of the derivatives. `offsets`: D at levels 1..254 of 255; `changes`: changes of the images' log
// exposures.
constexpr int kCorrections = 254;

// The estimate with a corrected response (then a table) and changed exposures.
Estimate corrected(const Problem &problem, const Estimate &first, const Eigen::VectorXd &offsets,
                   const Eigen::VectorXd &changes);

// Derivatives at 0 of every pair's predictions ([channel][direction]) along `offsets` and `changes`.
std::vector<double> prediction_rates(const Problem &problem, const Estimate &first, const Eigen::VectorXd &offsets,
                                     const Eigen::VectorXd &changes);

}  // namespace lensprof
