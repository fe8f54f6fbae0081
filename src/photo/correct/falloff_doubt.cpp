#include "photo/correct/falloff_doubt.hpp"

#include <algorithm>
#include <cmath>

#include "falloff/rise.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

// Half diagonals from the centre of the falloff to the farthest corner, or place of the circle.
double farthest_place(const lensprof_vignetting &falloff, uint32_t width, uint32_t height, bool is_circular) {
    if (width == 0 || height == 0) width = 3, height = 2;
    const double diagonal = std::hypot(width, height);
    if (is_circular) return std::hypot(falloff.center[0], falloff.center[1]) + std::min(width, height) / diagonal;
    return std::hypot(std::abs(falloff.center[0]) + width / diagonal, std::abs(falloff.center[1]) + height / diagonal);
}

double farthest_of_circle(const lensprof_vignetting &falloff, const lensprof_image_circle &circle) {
    if (circle.radius == 0.0) return INFINITY;
    return circle.radius + std::hypot(circle.center[0] - falloff.center[0], circle.center[1] - falloff.center[1]);
}

std::string impossible_curve(const lensprof_profile &profile, uint32_t channel, double farthest) {
    constexpr double errors_of_evidence = 2.0;  // standard errors
    const auto m_of = [&](double r2, double *sigma = nullptr) {
        return lensprof_profile_radial_falloff(&profile, channel, std::sqrt(r2), sigma);
    };
    const Course course = course_of(farthest * farthest, m_of, [&](double r2, double rise) {
        double sigma = LENSPROF_UNKNOWN;
        m_of(r2, &sigma);
        const bool is_evident = sigma != LENSPROF_UNKNOWN && sigma > 0.0 && rise > errors_of_evidence * sigma;
        return rise > kSmallRise && !is_evident;
    });
    const double bright = course.highest.m - kLargestRise, dark = kSmallestM - course.lowest.m;
    if (std::max(bright, dark) > 0.0) {
        const MAt extreme = bright > dark ? course.highest : course.lowest;
        return format("its falloff %s to %.2f times the centre, %.2f half diagonals from it",
                      extreme.m > 1.0 ? "rises" : "falls", extreme.m, std::sqrt(extreme.r2));
    }
    return course.rise.m > 0.0 ? format("its falloff rises outward by %.2f, up to %.2f half diagonals from the centre",
                                        course.rise.m, std::sqrt(course.rise.r2))
                               : "";
}

}  // namespace

std::string impossible_falloff(const lensprof_profile &profile, uint32_t width, uint32_t height, bool is_circular) {
    std::string text;
    for (uint32_t c = 0; c < profile.vignettings && text.empty() && profile.grid.columns == 0; c++) {
        const lensprof_vignetting &falloff = profile.vignetting[c];
        const double in_frame = farthest_place(falloff, width, height, is_circular);
        text = impossible_curve(profile, c, std::min(in_frame, farthest_of_circle(falloff, profile.image_circle)));
    }
    return text;
}

}  // namespace lensprof
