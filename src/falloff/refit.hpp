// Radial falloffs of other shapes than ours (gains, higher powers, knots), to M = 1 + k1 r^2 + k2 r^4 + k3 r^6. Least
// squares of the relative error M / attenuation - 1, which is that of a corrected value: a truncated series of 1 /
// gain, which other programs use, is wrong by up to a quarter at two stops.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace lensprof {

constexpr double kLowestFalloff = 0.001;  // of M that lensprof_vignetting_validate accepts

// 1 + terms[0] t + terms[1] t^2 + ... for a target sampled evenly in t over 0..1, target(0) taken as 1. Throws
// NOT_FINITE or VIGNETTING for what is not finite, or not above 0, there.
struct EvenRefit {
    std::vector<double> terms;
    double worst;  // largest |polynomial / target - 1|
};
EvenRefit refit_even(const std::function<double(double t)> &target, uint32_t count);

// A radial attenuation, r^2 in half diagonals, sampled evenly in r^2, that is evenly over the area, up to r = `reach`
// half diagonals. The attenuation in the centre is taken as 1. Throws as refit_even.
struct RadialRefit {
    std::array<double, 3> k;
    double worst;  // largest |M / attenuation - 1|
};
RadialRefit refit_radial(const std::function<double(double r2)> &attenuation, double reach = 1.0);

// s (1 + k1 r^2 + ... + kn r^2n), n = `count` of 1..3, to attenuations at any points of a frame: its k, the others 0.
struct FrameSample {
    double r2, attenuation, weight = 1.0;
};
std::array<double, 3> refit_samples(const std::vector<FrameSample> &samples, int count);

// Coefficients of r^2, r^4, r^6 for r in half diagonals, from those for r in `unit` half diagonals:
// (rho / unit)^2n a_n = rho^2n a_n unit^-2n. Units: Hugin and Lensfun's pa 1; Lensfun's and Adobe's acm
// focal_mm / half_diagonal_mm(crop_factor).
inline std::array<double, 3> in_half_diagonals(const std::array<double, 3> &terms, double unit) {
    const double s = 1.0 / (unit * unit);
    return {terms[0] * s, terms[1] * s * s, terms[2] * s * s * s};
}

}  // namespace lensprof
