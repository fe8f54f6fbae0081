// Common subjects that are hard for a fit: little texture, too much of it, too much contrast.
#include <cmath>

#include "cli/simulate/scene_maths.hpp"
#include "cli/simulate/simulated_scene.hpp"

namespace lensprof {

void SimulatedScene::sky(const Ray &ray, double rgb[3]) const {
    const double low = ramp(-1.2, 0.5, ray.latitude);  // 1: at the horizon
    const double high[3] = {0.09, 0.18, 0.42}, haze[3] = {0.38, 0.46, 0.60};
    const double clouded = draw(0, 0, 31) < 0.5 ? 0.0 : 0.5;
    const double cloud = clouded > 0.0 ? clouded * ramp(0.02, 0.5, fractal(ray.d, 2.2, 3)) : 0.0;
    double transmission = 1.0;  // neither wire nor pole
    for (uint32_t w = 0; w < 3; w++) {
        const double height = -0.25 + 0.5 * draw(w, 0, 32), sag = 0.06 * std::cos(6.0 * ray.longitude + w);
        transmission -= 0.93 * transmission * line(ray.latitude - height - sag, 0.0016);
    }
    const double pole = from_whole(ray.longitude / 0.9 + draw(0, 0, 33)) * 0.9;
    if (ray.latitude > -0.1) transmission -= 0.9 * transmission * line(pole, 0.006);
    for (int c = 0; c < 3; c++) rgb[c] = mix(mix(high[c], haze[c], low), 0.8, cloud) * transmission;
}

void SimulatedScene::wall(const Ray &ray, double rgb[3]) const {
    const double u = ray.longitude / 0.9 + draw(0, 0, 41), v = ray.latitude / 0.7 + draw(0, 0, 42);
    const double panel = 1.0 + 0.08 * (draw(u, v, 43) - 0.5);
    const double seam = std::fmax(line(from_whole(u - 0.5) * 0.9, 0.0025), line(from_whole(v - 0.5) * 0.7, 0.0025));
    const double light = std::exp(0.35 * fractal(ray.d, 0.9, 2) + 0.3 * ray.latitude);
    const double plaster = 1.0 + 0.07 * fractal(ray.d, 70.0, 3);
    const double paint[3] = {0.27, 0.245, 0.20};
    for (int c = 0; c < 3; c++) rgb[c] = paint[c] * light * panel * plaster * (1.0 - 0.5 * seam);
}

void SimulatedScene::foliage(const Ray &ray, double rgb[3]) const {
    const double gap = ramp(0.16, 0.24, fractal(ray.d, 22.0, 4));
    const double leaf = std::exp(3.4 * fractal(ray.d, 70.0, 3) + 1.2 * fractal(ray.d, 7.0, 2));
    const double hue = ramp(-0.4, 0.4, fractal(ray.d, 11.0, 2));
    const double green[3] = {mix(0.05, 0.15, hue), mix(0.11, 0.17, hue), mix(0.035, 0.04, hue)};
    const double bright[3] = {0.75, 0.85, 0.95};
    for (int c = 0; c < 3; c++) rgb[c] = std::fmax(mix(green[c] * leaf, bright[c], gap), 1e-3);
}

void SimulatedScene::interior(const Ray &ray, double rgb[3]) const {
    // Furniture and pictures: flat boxes on a wall lit dimly by the windows.
    const double u = ray.longitude * 5.0, v = ray.latitude * 6.0;
    const double inset = std::fmax(std::fabs(from_whole(u - 0.5)), std::fabs(from_whole(v - 0.5)));
    const double wood = 1.0 + 0.5 * fractal(ray.d, 30.0, 3), lit = std::exp(0.6 * fractal(ray.d, 1.5, 2));
    const bool box = draw(u, v, 51) < 0.55 && inset < 0.25 + 0.2 * draw(u, v, 52);
    // Windows with bars, every 0.75 radians.
    const double across = from_whole(ray.longitude / 0.75 + draw(0, 0, 53)) * 0.75, up = ray.latitude + 0.12;
    const bool pane = std::fabs(across) < 0.17 && std::fabs(up) < 0.22;
    const double bar =
        std::fmax(line(from_whole(across / 0.17) * 0.17, 0.008), line(from_whole(up / 0.22) * 0.22, 0.008));
    const double outside = 1.1 * (1.0 + 0.8 * fractal(ray.d, 6.0, 4)) * mix(1.0, 0.5, ramp(-0.2, 0.15, ray.latitude));
    for (uint32_t c = 0; c < 3; c++) {
        const double warm = 1.3 - 0.25 * c, painted = std::exp(-4.6 + 2.6 * draw(u, v, 54) + 0.8 * draw(u, v, 55 + c));
        const double room = (box ? painted : 0.035 * warm) * wood * lit;
        rgb[c] = std::fmax(pane ? mix(outside, 0.02 * warm, bar) : room, 1e-3);
    }
}

}  // namespace lensprof
