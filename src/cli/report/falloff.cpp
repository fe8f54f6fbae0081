#include "cli/report/falloff.hpp"

#include <cmath>

namespace lensprof {

bool Certainty::knows(uint32_t curve) const { return falloff_sigma(curve, 1.0) > 0.0; }

// dM/dk_n = r^(2n): the variance is that of a weighted sum.
double Certainty::falloff_sigma(uint32_t curve, double r2) const {
    const double slope[3] = {r2, r2 * r2, r2 * r2 * r2};
    const uint32_t first = modes + 3 * curve;
    double variance = 0.0;
    for (uint32_t i = 0; i < 3 && first + 3 <= size; i++)
        for (uint32_t j = 0; j < 3; j++) variance += slope[i] * slope[j] * covariance[(first + i) * size + first + j];
    return variance > 0.0 ? std::sqrt(variance) : 0.0;
}

}  // namespace lensprof
