// Falloffs of fits and profiles, for tables and charts.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <lensprof/lensprof.h>

#include "photo/base/library.hpp"

namespace lensprof {

// False if M is 1 everywhere: a falloff fixed at zero, or not measured, as by `bracket`.
inline bool has_falloff(const lensprof_vignetting &v) { return v.k[0] != 0.0 || v.k[1] != 0.0 || v.k[2] != 0.0; }

// Which of the falloff curves is that of green: of one per channel the second, else the only one.
constexpr uint32_t green_curve(size_t curves) { return curves == 3 ? 1 : 0; }

constexpr double usual_aspect = 1.5;  // of a frame whose size is unknown

// Half diagonals from the middle of the frame to the edge of the image circle, less than a pixel inside; without one
// infinite.
inline double reach_of_circle(const lensprof_image_circle &circle, double angle) {
    if (circle.radius == 0.0) return INFINITY;
    const double *c = circle.center, along = c[0] * std::cos(angle) + c[1] * std::sin(angle);
    const double square = along * along + circle.radius * circle.radius - c[0] * c[0] - c[1] * c[1];
    return (1.0 - 1e-6) * std::max(along + std::sqrt(std::max(square, 0.0)), 0.0);
}

// M times the gain grid at r half diagonals from the middle of a frame of this width over height, or at the edge of the
// image circle if that is nearer: mean of a circle or, at r = 1, of the corners.
inline double mean_light(const lensprof_profile &profile, uint32_t channel, double r, double aspect = usual_aspect) {
    constexpr double side = 30000.0;  // so large that the outermost pixels are in the corners
    constexpr int count = 64;
    const auto width = static_cast<uint32_t>(std::lround(side * std::min(aspect, 1.0))),
               height = static_cast<uint32_t>(std::lround(side * std::min(1.0 / aspect, 1.0)));
    const double half_width = 0.5 * (width - 1.0), half_height = 0.5 * (height - 1.0);
    const double diagonal = std::hypot(half_width, half_height), corner = std::atan2(half_height, half_width);
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        const double at_corner = (i & 1) ? M_PI - corner : corner;
        const double angle = r < 1.0 ? 2.0 * M_PI * i / count : (i & 2) ? -at_corner : at_corner;
        const double reach = diagonal * std::min(r, reach_of_circle(profile.image_circle, angle));
        sum += lensprof_profile_falloff(&profile, channel, width, height, half_width + reach * std::cos(angle),
                                        half_height + reach * std::sin(angle), nullptr);
    }
    return sum / count;
}

// The profile of a lens setting of a fit with its covariance; key and origin are still empty.
inline std::unique_ptr<lensprof_profile> profile_of(const lensprof_fit &fit,
                                                    uint32_t setting = LENSPROF_FIT_REFERENCE) {
    auto profile = new_profile();
    lensprof_error error{};
    check(lensprof_fit_profile(&fit, setting, profile.get(), &error), "fit", &error);
    return profile;
}

// The same for a card.
inline std::unique_ptr<lensprof_profile> profile_of(const lensprof_flat &flat) {
    auto profile = new_profile();
    lensprof_error error{};
    check(lensprof_flat_profile(&flat, profile.get(), &error), "fit", &error);
    return profile;
}

}  // namespace lensprof
