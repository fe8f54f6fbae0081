// Whether a result evens out its own pictures, independent of whether it is usable as a profile.
#pragma once

#include "fit/verdict/finish.hpp"
#include "fit/verdict/result.hpp"

namespace lensprof {

// Fills `evens`. Adds a warning to a usable result that leaves seams or contradicts many pairs.
void judge_evenness(const Found &found, FitResult &result);

}  // namespace lensprof
