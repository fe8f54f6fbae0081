// Whether a result evens out its own pictures, independent of whether it is usable as a profile.
#pragma once

#include "fit/verdict/finish.hpp"

namespace lensprof {

// Fills `evens`. Adds a warning to a usable result that leaves seams or contradicts many pairs.
void judge_evenness(const Found &found, lensprof_fit_result &result);

}  // namespace lensprof
