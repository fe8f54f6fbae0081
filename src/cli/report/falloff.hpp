// How sure a falloff curve is.
#pragma once

#include <lensprof/profile.h>

namespace lensprof {

// What is known of the estimated parameters: their covariance, and the number of those before the first falloff
// curve.
struct Certainty {
    const double *covariance;
    uint32_t size, modes;

    // False where the covariance does not reach to this falloff curve, or has nothing of it (a falloff held fixed).
    bool knows(uint32_t curve) const;

    // Standard error of M at r^2 in this curve; 0 where it is not known.
    double falloff_sigma(uint32_t curve, double r2) const;
};

// False where all is light as the centre is: a falloff held at none, or not measured, as by `bracket`.
inline bool has_falloff(const lensprof_vignetting &v) { return v.k[0] != 0.0 || v.k[1] != 0.0 || v.k[2] != 0.0; }

inline Certainty certainty_of(const lensprof_profile &profile) {
    return {profile.covariance, profile.covariance_size, profile.response[0].modes};
}

}  // namespace lensprof
