// Falloffs of fits and profiles, for tables and charts.
#pragma once

#include <memory>
#include <vector>

#include <lensprof/lensprof.h>

#include "photo/base/library.hpp"

namespace lensprof {

// False if M is 1 everywhere: a falloff fixed at zero, or not measured, as by `bracket`.
inline bool has_falloff(const lensprof_vignetting &v) { return v.k[0] != 0.0 || v.k[1] != 0.0 || v.k[2] != 0.0; }

// Which of the falloff curves is that of green: of one per channel the second, else the only one.
constexpr uint32_t green_curve(size_t curves) { return curves == 3 ? 1 : 0; }

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
