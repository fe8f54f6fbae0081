// Pseudo-random numbers from any numbers: SplitMix64 (Steele, Lea and Flood 2014).
#pragma once

#include <cstdint>

namespace lensprof {

constexpr uint64_t splitmix_step = 0x9E3779B97F4A7C15ull;  // increment of the sequence

constexpr uint64_t mixed_bits(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return x ^ (x >> 31);
}

}  // namespace lensprof
