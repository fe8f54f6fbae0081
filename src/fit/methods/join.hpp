// Cameras that photographed one scene, each fitted on its own pictures: what makes their light the same.
//
// A fit leaves the exponent gamma of its camera to the prior, and its exposures to its own reference. Light that two
// cameras saw ties these to each other's. With l = ln f^-1(B) - ln M - ln(e w), the light behind a grey value by the
// fit of its camera, every pair with ends in cameras a and b says in each channel
//
//     gamma_a l_a + b_a = gamma_b l_b + b_b.
//
// Both ends have errors: a residual counts in units of its own standard deviation, which gamma scales, too, since least
// squares of one end would find gammas too small. ln gamma of each camera has its own prior, 0 with the standard error
// of the fit. Pairs that disagree lose their weight.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace lensprof {

constexpr size_t kFewestJoining = 30;             // pairs that join a camera or an image
constexpr double kLargestLightDifference = 0.25;  // of the light at their ends, median, natural logarithm

// What two cameras saw of one place, by their own fits.
struct LightPair {
    uint32_t camera[2];
    uint32_t image[2];
    double log_light[2][3], variance[2][3];
};

// What joins a camera to the reference's.
struct Joint {
    bool joined = false;
    uint32_t pairs = 0;         // with an end in this camera, and the other in one that joined
    double inlier_share = 0.0;  // of these, those within 3 sigma of what is left
    double residual = 0.0;      // median absolute difference of light, natural logarithm
    double log_gamma = 0.0, log_gamma_sigma = 0.0;
    std::array<double, 3> offset{};         // b of each channel, natural logarithm
    double offset_sigma = 0.0;              // of the one that exposures are measured in, by the pairs
    std::array<double, 3> balance_sigma{};  // of the others less that one
};

// gamma_sigma: of ln gamma of each camera; 0 where it is known. `channels` 1 or 3.
// Cancelled is thrown where `cancelled` says so.
std::vector<Joint> join_cameras(const std::vector<LightPair> &pairs, const std::vector<double> &gamma_sigma,
                                uint32_t reference, int channels, const std::function<bool()> &cancelled);

}  // namespace lensprof
