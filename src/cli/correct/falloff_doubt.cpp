#include "cli/correct/falloff_doubt.hpp"

#include <algorithm>
#include <cmath>

#include "cli/program/format.hpp"

namespace lensprof {
namespace {

constexpr double darkest = 0.05, brightest = 1.05;  // M that a lens, or a camera that corrects it, can have
constexpr double largest_rise = 0.02;       // of M with growing r; 99 % of Lensfun's measured falloffs rise less
constexpr double errors_of_evidence = 2.0;  // standard errors
constexpr int steps = 64;                   // of r

// Half diagonals from the centre of the falloff to the farthest corner, or place of the circle.
double farthest_place(const lensprof_vignetting &falloff, uint32_t width, uint32_t height, bool is_circular) {
    if (width == 0 || height == 0) width = 3, height = 2;
    const double diagonal = std::hypot(width, height);
    if (is_circular) return std::hypot(falloff.center[0], falloff.center[1]) + std::min(width, height) / diagonal;
    return std::hypot(std::abs(falloff.center[0]) + width / diagonal, std::abs(falloff.center[1]) + height / diagonal);
}

std::string impossible_curve(const lensprof_profile &profile, uint32_t channel, double farthest) {
    double lowest = 1.0, extreme = 1.0, extreme_r = 0.0, rise = 0.0, rise_r = 0.0;
    for (int i = 1; i <= steps; i++) {
        double sigma = LENSPROF_UNKNOWN;
        const double r = farthest * i / steps, m = lensprof_profile_radial_falloff(&profile, channel, r, &sigma);
        const double excess = std::max(darkest - m, m - brightest);
        if (excess > 0.0 && excess > std::max(darkest - extreme, extreme - brightest)) extreme = m, extreme_r = r;
        const bool is_evident = sigma != LENSPROF_UNKNOWN && sigma > 0.0 && m - lowest > errors_of_evidence * sigma;
        if (!is_evident && m - lowest > std::max(rise, largest_rise)) rise = m - lowest, rise_r = r;
        lowest = std::min(lowest, m);
    }
    if (extreme_r > 0.0)
        return format("its falloff %s to %.2f times the centre, %.2f half diagonals from it",
                      extreme > 1.0 ? "rises" : "falls", extreme, extreme_r);
    return rise > 0.0
               ? format("its falloff rises outward by %.2f, up to %.2f half diagonals from the centre", rise, rise_r)
               : "";
}

}  // namespace

std::string impossible_falloff(const lensprof_profile &profile, uint32_t width, uint32_t height, bool is_circular) {
    std::string text;
    for (uint32_t c = 0; c < profile.vignettings && text.empty() && profile.grid.columns == 0; c++)
        text = impossible_curve(profile, c, farthest_place(profile.vignetting[c], width, height, is_circular));
    return text;
}

}  // namespace lensprof
