// Procedural textures of 3D surfaces, filtered by distance.
#pragma once

#include <cstdint>

namespace lensprof {

// Octaves of noise that multiply a colour.
struct Grain {
    uint32_t seed;
    double cell_m;     // of the coarsest octave
    double amplitude;  // of every octave, below 0.7
};

// Smooth noise in -1..1 with features of a cell of size 1.
double noise2(double u, double v, uint32_t seed);

// Multiplies the colour by all octaves, each with its own tint. Octaves finer than `footprint_m` have faded to their
// mean.
void add_grain(const Grain &grain, double u_m, double v_m, double footprint_m, double rgb[3]);

// 1 on the joints of a lattice with cells of size 1, 0 elsewhere; half a joint's width and a footprint in cells. Joints
// thinner than the footprint get lighter as they get wider.
double joint(double u, double v, double half_width, double footprint);

// A number 0..1 per cell of a lattice.
double cell_draw(double u, double v, uint32_t what, uint32_t seed);

// A colour per cell: dark to bright, tinted, with this median brightness.
void cell_colour(double u, double v, uint32_t seed, double brightness, double rgb[3]);

}  // namespace lensprof
