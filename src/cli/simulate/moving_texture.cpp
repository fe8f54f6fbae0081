#include "cli/simulate/moving_texture.hpp"

#include <algorithm>
#include <cmath>

#include "cli/simulate/scene_maths.hpp"

namespace lensprof {
namespace {

constexpr int kMaxOctaves = 24;
constexpr double kTints[4][3] = {{1.0, 1.0, 1.0}, {1.25, 1.0, 0.7}, {0.75, 1.0, 1.25}, {1.1, 0.8, 1.1}};

uint32_t cell_of(double x) { return static_cast<uint32_t>(static_cast<int32_t>(std::floor(x))); }

}  // namespace

double noise2(double u, double v, uint32_t seed) {
    const double fu = std::floor(u), fv = std::floor(v), tu = smooth(u - fu), tv = smooth(v - fv);
    const uint32_t i = cell_of(u), j = cell_of(v);
    const double above = mix(unit(hash(i, j, 1, seed)), unit(hash(i + 1, j, 1, seed)), tu);
    const double below = mix(unit(hash(i, j + 1, 1, seed)), unit(hash(i + 1, j + 1, 1, seed)), tu);
    return 2.0 * mix(above, below, tv) - 1.0;
}

void add_grain(const Grain &grain, double u_m, double v_m, double footprint_m, double rgb[3]) {
    double u = u_m / grain.cell_m, v = v_m / grain.cell_m, cell_m = grain.cell_m;
    for (int o = 0; o < kMaxOctaves; o++, cell_m *= 0.5) {
        const double fade = ramp(0.9, 2.2, cell_m / footprint_m);
        if (fade <= 0.0) return;
        const double noise = noise2(u, v, grain.seed + static_cast<uint32_t>(o) * 1013u);
        for (int c = 0; c < 3; c++) rgb[c] *= 1.0 + grain.amplitude * fade * noise * kTints[o % 4][c];
        const double rotated = 2.0 * (0.8 * u - 0.6 * v);  // so that no lattice shows
        v = 2.0 * (0.6 * u + 0.8 * v), u = rotated;
    }
}

double joint(double u, double v, double half_width, double footprint) {
    const double distance = std::min(std::fabs(from_whole(u)), std::fabs(from_whole(v)));
    const double wide = std::max(half_width, footprint);
    return half_width / wide * (1.0 - ramp(0.6 * wide, 1.4 * wide, distance));
}

double cell_draw(double u, double v, uint32_t what, uint32_t seed) {
    return unit(hash(cell_of(u), cell_of(v), what, seed));
}

void cell_colour(double u, double v, uint32_t seed, double brightness, double rgb[3]) {
    const double bright = brightness * std::exp(1.9 * (cell_draw(u, v, 3, seed) - 0.5));
    for (uint32_t c = 0; c < 3; c++)
        rgb[c] = std::min(bright * std::exp(1.1 * (cell_draw(u, v, 4 + c, seed) - 0.5)), 0.9);
}

}  // namespace lensprof
