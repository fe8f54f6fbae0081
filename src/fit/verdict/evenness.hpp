// Whether a result evens out the pictures that it was made from: another question than whether it is a profile.
#pragma once

#include "fit/verdict/finish.hpp"

namespace lensprof {

// Fills `evens`, and warns of a usable result that leaves seams or that many pairs disagree with.
void judge_evenness(const Found &found, lensprof_fit_result &result);

}  // namespace lensprof
