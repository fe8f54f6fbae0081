// What is known now, with standard errors, in the units of the pictures: with the exponent.
#pragma once

#include "fit/online/state.hpp"

namespace lensprof {
namespace online {

// Of a frame of the history.
lensprof_online_exposure exposure_of(const Memory &memory, int32_t frame);

lensprof_online_result result_of(const State &state);

// Response, falloff, covariance and provenance.
void put_profile(const State &state, lensprof_profile &profile);

}  // namespace online
}  // namespace lensprof
