// Exposures and white balances of pictures whose response and falloff are known: differences of the logarithm of light,
// channel by channel.
#pragma once

#include <cstdint>
#include <vector>

namespace lensprof {

// What two images say of one place in one channel.
struct LightDifference {
    uint32_t image[2];
    double log_ratio;  // ln of the light in the first over that in the second, without the falloff
    double sigma;      // what one level of 255 of noise in both makes of it; 0: it says nothing
};

// ln of the exposure of each image, up to a constant for all that are joined; 0 of an image that nothing joins. Robust:
// half of the differences less a few may be wrong, where the others agree.
std::vector<double> log_exposures(const std::vector<LightDifference> &differences, uint32_t images);

}  // namespace lensprof
