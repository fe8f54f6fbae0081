// The verdict on a result: the rules of rules.hpp, and whether its pictures are even.
#pragma once

#include <functional>

#include "fit/verdict/finish.hpp"

namespace lensprof {

// Fills `verdict`, `usable` and `equalizes` from everything else. `judge_result` adds what only the method knows, after
// the rules.
void judge(const Found &found, const std::function<void(FitResult &)> &judge_result, FitResult &r);

// What a method finds by itself, with the severity and the limit of its row in rules.hpp.
lensprof_finding found_by_method(lensprof_reason code, const Measured &measured);

}  // namespace lensprof
