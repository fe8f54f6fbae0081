// Building blocks of scenes.
#pragma once

#include <cmath>
#include <cstdint>

namespace lensprof {

inline double smooth(double t) { return t * t * (3.0 - 2.0 * t); }

inline double mix(double a, double b, double t) { return a + (b - a) * t; }

// 0 below `low`, 1 above `high`, smooth between.
inline double ramp(double low, double high, double x) {
    return smooth(std::fmin(std::fmax((x - low) / (high - low), 0.0), 1.0));
}

// 1 on a line about 0 of this half width, 0 off it.
inline double line(double distance, double half_width) {
    return 1.0 - ramp(0.6 * half_width, 1.4 * half_width, std::fabs(distance));
}

// Pseudo-random bits of four numbers; then as a number 0..1.
inline uint32_t hash(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    uint32_t h = a * 0x9e3779b1u ^ b * 0x85ebca77u ^ c * 0xc2b2ae3du ^ d * 0x27d4eb2fu;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    h ^= h >> 12;
    h *= 0x297a2d39u;
    return h ^ (h >> 15);
}

inline double unit(uint32_t h) { return h * (1.0 / 4294967296.0); }

// Distance to the nearest integer.
inline double from_whole(double x) { return x - std::floor(x + 0.5); }

}  // namespace lensprof
