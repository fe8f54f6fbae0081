// A Gauss-Newton step that keeps the response rising and the falloff positive.
#pragma once

#include "fit/online/state.hpp"

namespace lensprof {
namespace online {

// Minimises  1/2 s'Ss - pull's  over steps s to a possible camera; `inverse` = S^-1. At a bound that is the best step
// along it: a step that is merely shortened would end there.
Globals possible_step(const Camera &camera, const GlobalMatrix &inverse, const Globals &pull);

}  // namespace online
}  // namespace lensprof
