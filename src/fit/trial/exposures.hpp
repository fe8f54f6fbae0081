// Exposures and white balances of pictures with known response and falloff, from differences of log irradiance per
// channel.
#pragma once

#include <cstdint>
#include <vector>

namespace lensprof {

// A comparison of two images at one point in one channel.
struct IrradianceDifference {
    uint32_t image[2];
    double log_ratio;  // ln of the ratio of irradiance in the first to that in the second, without the falloff
    double sigma;      // its error from one level of 255 of noise in both; 0: no information
};

// ln of the exposure per image, up to a constant per connected set; 0 for unconnected images. Robust: nearly half of
// the differences may be wrong if the others agree.
std::vector<double> log_exposures(const std::vector<IrradianceDifference> &differences, uint32_t images);

}  // namespace lensprof
