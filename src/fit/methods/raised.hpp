// Moves a finished result along its family: (f, M, e) to (f o x^(1/gamma), M^gamma, e^gamma), which produce the same
// pictures. Also moves its exposures to another reference.
#pragma once

#include <array>
#include <set>
#include <vector>

#include <lensprof/fit.h>

#include "fit/verdict/result.hpp"

namespace lensprof {

// Raises response, falloffs and exposures of a result to the exponent exp(log_gamma), whose standard error is then
// `sigma`, and updates their errors accordingly. The response becomes a TABLE, which follows exactly; coefficients that
// are not `free` (LENSPROF_FREE_K1.._K3) stay. `settings`: the settings of the result that are its own. Exposures are
// relative to its reference's.
void raise_result(double log_gamma, double sigma, uint32_t free, const std::set<uint32_t> &settings,
                  std::vector<lensprof_exposure> &exposures, FitResult &result);

// Difference of the light of images, natural logarithm, with its standard errors: of the channel in which exposures are
// measured, and of the other channels relative to it.
struct Offset {
    std::array<double, 3> log_light;
    double sigma;
    std::array<double, 3> balance_sigma;
};

// Multiplies the light of all images by adjusting their exposures.
void offset_exposures(const Offset &offset, uint32_t channels, std::vector<lensprof_exposure> &exposures,
                      FitResult &result);

}  // namespace lensprof
