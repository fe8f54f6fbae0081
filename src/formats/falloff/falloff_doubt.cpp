#include "formats/falloff/falloff_doubt.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "falloff/refit.hpp"

namespace lensprof {
namespace {

constexpr int kSteps = 1000;    // radii between the centre and the corner farthest from it
constexpr double kRise = 0.05;  // of M, which is 1 at the centre: rare for a lens, common for a noisy fit

std::string with_numbers(const char *format, double a, double b = 0.0, double c = 0.0) {
    char text[64];
    std::snprintf(text, sizeof text, format, a, b, c);
    return text;
}

// Calls use(r, M) from the centre outwards until it returns true.
template <typename Use>
void walk_outwards(const lensprof_vignetting &vignetting, Use use) {
    const double reach = 1.0 + std::hypot(vignetting.center[0], vignetting.center[1]);
    for (int i = 0; i <= kSteps; i++) {
        const double r = reach * i / kSteps;
        if (use(r, lensprof_vignetting_eval(&vignetting, r * r, nullptr))) return;
    }
}

std::string why_unusable(const lensprof_vignetting &vignetting) {
    double radius = -1.0, lowest = kLowestFalloff;
    walk_outwards(vignetting, [&](double r, double m) {
        if (m < kLowestFalloff && radius < 0.0) radius = r;
        lowest = std::min(lowest, m);
        return false;
    });
    if (std::fabs(vignetting.center[0]) > 1.0 || std::fabs(vignetting.center[1]) > 1.0)
        return "the centre is outside the frame";
    if (radius < 0.0) return "a coefficient is too large";
    if (lowest >= 0.0) return with_numbers("M falls below 0.001 at r = %.2f", radius);
    walk_outwards(vignetting, [&](double r, double m) {
        radius = r;
        return m < 0.0;
    });
    return with_numbers("M is negative at r = %.2f", radius);
}

}  // namespace

FalloffDoubt find_doubt(const lensprof_vignetting &vignetting) {
    if (lensprof_vignetting_validate(&vignetting) != LENSPROF_OK) return {false, why_unusable(vignetting)};
    const double *k = vignetting.k;
    if (k[0] == -0.3 && k[1] == 0.0 && k[2] == 0.0) return {true, "start values of a fit that failed"};
    double lowest = 1.0, from = 1.0, to = 1.0, radius = 0.0;
    walk_outwards(vignetting, [&](double r, double m) {
        lowest = std::min(lowest, m);
        if (m - lowest > to - from) from = lowest, to = m, radius = r;
        return false;
    });
    if (to - from > kRise) return {true, with_numbers("M rises from %.3g to %.3g at r = %.2f", from, to, radius)};
    return {true, ""};
}

}  // namespace lensprof
