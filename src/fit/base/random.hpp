// Random numbers from a given seed.
#pragma once

#include "fit/base/mixed_bits.hpp"

namespace lensprof {

// splitmix64: a reproducible sequence for each seed, uniform in [0, 1).
struct Random {
    uint64_t state;

    double next() { return static_cast<double>(mixed_bits(state += splitmix_step) >> 11) * 0x1p-53; }
};

}  // namespace lensprof
