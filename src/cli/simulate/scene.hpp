// A procedural world: radiance of every direction, the same for every picture.
#pragma once

#include <cstdint>

namespace lensprof {

// A sky over fields and buildings: smooth gradients, flat patches of many colours and fine texture over about eight
// stops. Median radiance is near 0.16. Made of arithmetic and hashes alone: the same on every machine.
class Scene {
public:
    explicit Scene(uint32_t seed) : seed_(seed) {}

    // Radiance of red, green and blue in a direction (radians, latitude positive down).
    void radiance(double longitude, double latitude, double rgb[3]) const;

    // Sum of octaves of smooth noise at a point of space, the first with features of 1 / frequency; within +-1.1.
    double fractal(const double d[3], double frequency, int octaves) const;

private:
    double noise(double x, double y, double z, uint32_t octave) const;

    uint32_t seed_;
};

}  // namespace lensprof
