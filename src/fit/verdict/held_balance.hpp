// Detects white balances that are held although the pictures differ in them.
#pragma once

#include <cstdint>

#include "fit/problem/problem.hpp"

namespace lensprof {

// Colour difference of an image from its neighbours at places that should have equal colours according to the estimate:
// the mean over its links of the median residual of red or blue relative to that of green, levels of 255.
struct HeldBalance {
    double levels = 0.0;  // 0: no clear difference
    uint32_t image = 0;
};

// The largest difference, over images whose white balance is held and is not the reference's.
HeldBalance held_balance(const Problem &problem, const Estimate &estimate);

}  // namespace lensprof
