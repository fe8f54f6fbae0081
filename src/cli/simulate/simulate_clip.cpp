// Exposures that clip highlights.
#include <algorithm>
#include <cmath>

#include "cli/simulate/simulate.hpp"

namespace lensprof {

void clip_lights(double share, const SimulatedScene &scene, Truth &truth) {
    constexpr uint32_t kGrid = 64;  // points per side of every picture
    std::vector<double> stops;      // of the brightest channel, EV from white
    for (uint32_t i = 0; i < truth.cameras.size(); i++) {
        const auto &camera = truth.cameras[i];
        for (uint32_t v = 0; v < kGrid; v++)
            for (uint32_t u = 0; u < kGrid; u++) {
                const double x = (u + 0.5) / kGrid * camera.width - 0.5, y = (v + 0.5) / kGrid * camera.height - 0.5;
                double rgb[3], light[3];
                seen_radiance(truth, scene, i, x, y, rgb);
                irradiance_of(truth, i, x, y, rgb, light);
                stops.push_back(std::log2(std::max({light[0], light[1], light[2], 1e-9})));
            }
    }
    auto quantile = stops.begin() + static_cast<std::ptrdiff_t>((1.0 - share) * static_cast<double>(stops.size() - 1));
    std::nth_element(stops.begin(), quantile, stops.end());
    truth.clip_share = share;
    for (auto &exposure : truth.exposures) exposure.ev -= *quantile;
}

}  // namespace lensprof
