// The falloff that a candidate leaves in pictures, per ring of the frame, from all pairs.
//
//   ln g(B1) - ln g(B2) - [ln M(p1) - ln M(p2)] = b + d(r1) - d(r2) + sum_m c_m [h_m(B1) - h_m(B2)]
//
// b: ratio of the exposures of a link (two images) in a channel, d: remaining falloff, c_m: errors of the response, of
// which standard deviations are known. d is linear in r^2 between the ends of rings and 0 in the middle.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include <lensprof/trial.h>

#include "fit/trial/residuals.hpp"
#include "fit/trial/response_error.hpp"
#include "fit/trial/ring_nodes.hpp"

namespace lensprof {

// Means over the area of each ring, relative to that of the first, natural logarithm.
struct RingFalloff {
    uint32_t rings = 0;  // that the pictures show, from the middle on
    RingVector remaining = RingVector::Zero();
    RingMatrix covariance = RingMatrix::Zero();
    RingVector corrected = RingVector::Zero();  // ln M of the candidate
    RingVector area = RingVector::Zero();       // shares of the frame
};

// What is known of the response's gamma by the known exposures of the images is added to `response`.
RingFalloff remaining_falloff(const TrialPairs &pairs, const TrialModel &model, ResponseError response);

// Whether the frame is clearly flatter with the candidate than without any: mean square over the rings shown.
bool is_flatter(const RingFalloff &found);

// Fills in the members on corners and rings.
void put_rings(const RingFalloff &found, lensprof_trial_candidate &candidate);

}  // namespace lensprof
