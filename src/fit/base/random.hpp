// Random numbers from a given seed.
#pragma once

#include <cstdint>

namespace lensprof {

// splitmix64: a reproducible sequence for each seed, uniform in [0, 1).
struct Random {
    uint64_t state;

    double next() {
        uint64_t x = state += 0x9e3779b97f4a7c15ull;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
        return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-53;
    }
};

}  // namespace lensprof
