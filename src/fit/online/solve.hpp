// Steps of the fit, and what becomes of a full window.
#pragma once

#include "fit/online/state.hpp"

namespace lensprof {
namespace online {

// Whether another step would change anything.
bool is_pending(const State &state);

// One step.
void take_step(const Memory &memory);

}  // namespace online
}  // namespace lensprof
