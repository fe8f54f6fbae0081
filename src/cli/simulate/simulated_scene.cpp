#include "cli/simulate/simulated_scene.hpp"

#include <cmath>

#include "cli/simulate/scene_maths.hpp"

namespace lensprof {

// Value noise in -1..1 on a lattice of the sphere's space.
double SimulatedScene::noise(double x, double y, double z, uint32_t octave) const {
    double fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
    auto ix = static_cast<uint32_t>(static_cast<int32_t>(fx)), iy = static_cast<uint32_t>(static_cast<int32_t>(fy)),
         iz = static_cast<uint32_t>(static_cast<int32_t>(fz));
    double tx = smooth(x - fx), ty = smooth(y - fy), tz = smooth(z - fz), corner[8];
    for (uint32_t k = 0; k < 8; k++)
        corner[k] = unit(hash(ix + (k & 1), iy + (k >> 1 & 1), iz + (k >> 2), seed_ * 64 + octave));
    double low = mix(mix(corner[0], corner[1], tx), mix(corner[2], corner[3], tx), ty);
    double high = mix(mix(corner[4], corner[5], tx), mix(corner[6], corner[7], tx), ty);
    return 2.0 * mix(low, high, tz) - 1.0;
}

double SimulatedScene::fractal(const double d[3], double frequency, int octaves) const {
    double sum = 0.0, amplitude = 0.5;
    for (int o = 0; o < octaves; o++, frequency *= 2.03, amplitude *= 0.55)
        sum += amplitude
               * noise(frequency * d[0] + 17.0 * o, frequency * d[1], frequency * d[2], static_cast<uint32_t>(o));
    return sum;
}

double SimulatedScene::draw(double u, double v, uint32_t what) const {
    return unit(hash(static_cast<uint32_t>(static_cast<int32_t>(std::floor(u))),
                     static_cast<uint32_t>(static_cast<int32_t>(std::floor(v))), what, seed_));
}

const char *scene_word(SimulatedKind kind) {
    const char *const words[] = {"landscape", "sky", "wall", "foliage", "interior"};
    return words[static_cast<int>(kind)];
}

void SimulatedScene::radiance(double longitude, double latitude, double rgb[3]) const {
    const Ray ray = {
        longitude,
        latitude,
        {std::cos(latitude) * std::sin(longitude), std::sin(latitude), std::cos(latitude) * std::cos(longitude)}};
    switch (kind_) {
    case SimulatedKind::landscape: return landscape(ray, rgb);
    case SimulatedKind::sky: return sky(ray, rgb);
    case SimulatedKind::wall: return wall(ray, rgb);
    case SimulatedKind::foliage: return foliage(ray, rgb);
    case SimulatedKind::interior: return interior(ray, rgb);
    }
}

double SimulatedScene::nearness(double longitude, double latitude) const {
    return std::floor(kLayers * draw(longitude * 9.0, latitude * 14.0, 23)) / (kLayers - 1);
}

void SimulatedScene::landscape(const Ray &ray, double rgb[3]) const {
    const double above = 0.06 * fractal(ray.d, 4.0, 3) - ray.latitude;  // the horizon; positive: sky
    const double day = smooth(std::fmin(std::fmax(above / 0.02 + 0.5, 0.0), 1.0));
    double sky[3] = {0.0, 0.0, 0.0}, ground[3] = {0.0, 0.0, 0.0};
    if (day > 0.0) clouds(ray, above, sky);
    if (day < 1.0) fields(ray, ground);
    for (uint32_t c = 0; c < 3; c++) rgb[c] = std::fmax(mix(ground[c], sky[c], day), 1e-3);
}

void SimulatedScene::clouds(const Ray &ray, double above, double rgb[3]) const {
    const double height = std::fmin(std::fmax(above, 0.0), 1.2), cloud = std::fmax(0.0, fractal(ray.d, 3.0, 5) + 0.05);
    rgb[0] = 0.55 - 0.36 * height + 0.9 * cloud;
    rgb[1] = 0.62 - 0.30 * height + 0.85 * cloud;
    rgb[2] = 0.75 - 0.15 * height + 0.75 * cloud;
}

// Fields and walls: patches of one colour each, with soft borders and some texture.
void SimulatedScene::fields(const Ray &ray, double rgb[3]) const {
    const double u = ray.longitude * 9.0 + 0.3 * fractal(ray.d, 6.0, 2), v = ray.latitude * 14.0;
    const double fu = std::floor(u), fv = std::floor(v);
    const double edge = std::fmin(std::fmin(u - fu, 1.0 - (u - fu)), std::fmin(v - fv, 1.0 - (v - fv)));
    const double border = smooth(std::fmin(edge / 0.06, 1.0)), texture = std::exp(0.9 * fractal(ray.d, 25.0, 4));
    const auto cell_u = static_cast<uint32_t>(static_cast<int32_t>(fu)),
               cell_v = static_cast<uint32_t>(static_cast<int32_t>(fv));
    const double brightness = std::exp(-3.6 + 3.4 * unit(hash(cell_u, cell_v, 7, seed_)));
    for (uint32_t c = 0; c < 3; c++) {
        const double tint = std::exp(0.9 * (unit(hash(cell_u, cell_v, 11 + c, seed_)) - 0.5));
        rgb[c] = mix(0.05, brightness * tint, border) * texture;
    }
}

}  // namespace lensprof
