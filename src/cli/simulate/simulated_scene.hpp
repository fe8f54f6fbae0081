// A procedural scene: radiance by direction, the same for every picture.
#pragma once

#include <cstdint>

namespace lensprof {

enum class SimulatedKind {
    landscape,
    sky,
    wall,
    foliage,
    interior
};

const char *scene_word(SimulatedKind kind);  // "landscape", ...

// Made of arithmetic and hashes alone: the same on every machine. Median radiance is near 0.16.
// - landscape: a sky over fields and buildings: smooth gradients, flat patches of many colours and fine texture over
//   about eight stops;
// - sky: a blue gradient, in some seeds with soft clouds, a few wires and poles;
// - wall: plaster of panels that are almost alike, their texture 1..3 %, with seams between them;
// - foliage: leaves before bright gaps, strong fine texture everywhere;
// - interior: a dark room with bright windows, hard edges over some eight stops.
class SimulatedScene {
public:
    explicit SimulatedScene(uint32_t seed, SimulatedKind kind = SimulatedKind::landscape) : seed_(seed), kind_(kind) {}

    // Radiance of red, green and blue in a direction (radians, latitude positive down).
    void radiance(double longitude, double latitude, double rgb[3]) const;

    // Nearness of the object in a direction: 0 = far, 1 = nearest; one of kLayers steps per cell of a lattice.
    double nearness(double longitude, double latitude) const;
    static constexpr int kLayers = 3;

    // Sum of octaves of smooth noise at a point in space, the first with features of 1 / frequency; within +-1.1.
    double fractal(const double d[3], double frequency, int octaves) const;

private:
    // A direction: its angles and its unit vector.
    struct Ray {
        double longitude, latitude, d[3];
    };
    double noise(double x, double y, double z, uint32_t octave) const;
    double draw(double u, double v, uint32_t what) const;  // a number 0..1 per cell of a lattice
    void landscape(const Ray &ray, double rgb[3]) const;
    void clouds(const Ray &ray, double above, double rgb[3]) const;  // `above`: radians above the horizon
    void fields(const Ray &ray, double rgb[3]) const;
    void sky(const Ray &ray, double rgb[3]) const;
    void wall(const Ray &ray, double rgb[3]) const;
    void foliage(const Ray &ray, double rgb[3]) const;
    void interior(const Ray &ray, double rgb[3]) const;

    uint32_t seed_;
    SimulatedKind kind_;
};

}  // namespace lensprof
