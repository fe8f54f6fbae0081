// White balances that are held though the pictures differ in them.
#pragma once

#include <cstdint>

#include "fit/problem/problem.hpp"

namespace lensprof {

// By how much the colours of an image differ from those of its neighbours where the estimate takes them for equal: the
// mean over its links of the median residual of red or blue beside that of green, levels of 255.
struct HeldBalance {
    double levels = 0.0;  // 0: none differs clearly
    uint32_t image = 0;
};

// The largest, of images whose white balance is held and not that of the reference.
HeldBalance held_balance(const Problem &problem, const Estimate &estimate);

}  // namespace lensprof
