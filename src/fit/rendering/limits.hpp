// The limits of verdicts on renderings, each with what it is derived from.
#pragma once

namespace lensprof {
namespace rendering_limits {

constexpr double kFewestTenths = 4.0;       // of the grey values, as for pairs
constexpr double kLargestNoise = 6.0;       // of an area, levels of 255, as for pairs: above the noise of any camera
constexpr double kStrongMap = 1.2;          // of residuals over the frame, levels of 255
constexpr double kWeakMap = 0.5;            // what rounding can leave
constexpr double kLargestGammaSigma = 0.1;  // of ln gamma: 10 % of the exponent
constexpr double kMissingGreys = 48.0 / 255.0;  // at the dark or the bright end

}  // namespace rendering_limits
}  // namespace lensprof
