// A finished result moved along its family: (f, M, e) to (f o x^(1/gamma), M^gamma, e^gamma), which make the same
// pictures, and its exposures moved to another reference.
#pragma once

#include <array>
#include <set>
#include <vector>

#include <lensprof/fit.h>

namespace lensprof {

// Raises response, falloffs and exposures of a result to the exponent exp(log_gamma), whose standard error then is
// `sigma`, and states their errors by that. The response becomes a TABLE, which follows exactly; the coefficients that
// are not `free` (LENSPROF_FREE_K1.._K3) stay. `settings`: those of the result that are its own. Exposures are relative
// to its reference's.
void raise_result(double log_gamma, double sigma, uint32_t free, const std::set<uint32_t> &settings,
                  std::vector<lensprof_exposure> &exposures, lensprof_fit_result &result);

// By how much the light of images differs, natural logarithm, with its standard errors: that of the channel which
// exposures are measured in, and of the others less that one.
struct Offset {
    std::array<double, 3> log_light;
    double sigma;
    std::array<double, 3> balance_sigma;
};

// Multiplies the light of all images, as their exposures have it.
void offset_exposures(const Offset &offset, uint32_t channels, std::vector<lensprof_exposure> &exposures,
                      lensprof_fit_result &result);

}  // namespace lensprof
