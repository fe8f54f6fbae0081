// Cameras that photographed one scene, each fitted to its own pictures: brings their light to one scale.
//
// A fit leaves the exponent gamma of its camera to the prior, and its exposures to its own reference. Light that
// two cameras saw ties both together. With l = ln f^-1(B) - ln M - ln(e w), the light at a grey value according
// to the fit of its camera, every pair with ends in cameras a and b gives in each channel
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

constexpr size_t kMinJoiningPairs = 30;           // pairs needed to join a camera or an image
constexpr double kLargestLightDifference = 0.25;  // median difference of the light at their ends, natural logarithm

// The light of one scene point in two cameras, according to their own fits.
struct LightPair {
    uint32_t camera[2];
    uint32_t image[2];
    double log_light[2][3], variance[2][3];
};

// The connection of a camera to the reference camera.
struct Joint {
    bool joined = false;
    uint32_t pairs = 0;         // with one end in this camera, and the other in a camera that is joined
    double inlier_share = 0.0;  // share of these within 3 sigma of the scatter
    double residual = 0.0;      // median absolute difference of light, natural logarithm
    double log_gamma = 0.0, log_gamma_sigma = 0.0;
    std::array<double, 3> offset{};         // b per channel, natural logarithm
    double offset_sigma = 0.0;              // of the channel in which exposures are measured, according to the pairs
    std::array<double, 3> balance_sigma{};  // of the other channels relative to that one
};

// gamma_sigma: standard error of ln gamma per camera; 0 if known. `channels` 1 or 3. Throws Cancelled if `cancelled`
// returns true.
std::vector<Joint> join_cameras(const std::vector<LightPair> &pairs, const std::vector<double> &gamma_sigma,
                                uint32_t reference, int channels, const std::function<bool()> &cancelled);

}  // namespace lensprof
