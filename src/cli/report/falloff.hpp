// Falloffs of fits and profiles, for tables and charts.
#pragma once

#include <memory>
#include <vector>

#include <lensprof/lensprof.h>

#include "cli/program/library.hpp"

namespace lensprof {

// False if M is 1 everywhere: a falloff fixed at zero, or not measured, as by `bracket`.
inline bool has_falloff(const lensprof_vignetting &v) { return v.k[0] != 0.0 || v.k[1] != 0.0 || v.k[2] != 0.0; }

// Which of the falloff curves is that of green: of one per channel the second, else the only one.
constexpr uint32_t green_curve(size_t curves) { return curves == 3 ? 1 : 0; }

// The profile of a fit with its covariance; key and origin are still empty.
inline std::unique_ptr<lensprof_profile> profile_of(const lensprof_fit_result &fit,
                                                    const lensprof_fit_options *options = nullptr, size_t images = 0) {
    auto profile = new_profile();
    lensprof_error error{};
    check(lensprof_profile_from_fit(profile.get(), &fit, options, static_cast<uint32_t>(images), &error), "fit",
          &error);
    return profile;
}

// The same for a card, with the responses of its pictures.
inline std::unique_ptr<lensprof_profile>
profile_of(const lensprof_flat_result &fit, const std::vector<lensprof_response> &responses, size_t images = 0) {
    auto profile = new_profile();
    lensprof_flat_options options;
    lensprof_flat_options_init(&options);
    options.response = responses.data();
    options.responses = static_cast<uint32_t>(responses.size());
    lensprof_error error{};
    check(lensprof_profile_from_flat(profile.get(), &fit, &options, static_cast<uint32_t>(images), &error), "fit",
          &error);
    return profile;
}

}  // namespace lensprof
