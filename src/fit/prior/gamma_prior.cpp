#include "fit/prior/gamma_prior.hpp"

#include <algorithm>
#include <cmath>

#include "core/response.h"
#include "fit/prior/gamma_prior_table.hpp"

namespace lensprof {

const GammaPrior &gamma_prior(uint32_t camera_kind) { return kGammaPriors[camera_kind]; }

double gamma_position(const double *table) {
    double x = std::clamp(lp_curve_invert(table, kGaugeGrey, nullptr), 1e-9, 1.0 - 1e-9);
    return std::log(std::log(x) / std::log(kGaugeIrradiance));
}

double expected_position(const GammaPrior &prior, const double *table) {
    double exponent = std::exp(gamma_position(table)), shape[3], z[3], length2 = 0.0;
    for (int i = 0; i < 3; i++)
        shape[i] = lp_curve_eval(table, std::pow(kShapePoints[i], exponent), nullptr) - prior.mean[i];
    for (int i = 0; i < 3; i++) {
        z[i] = 0.0;
        for (int j = 0; j < 3; j++) z[i] += prior.whiten[i][j] * shape[j];
        length2 += z[i] * z[i];
    }
    double shrink = std::min(1.0, kLargestShape / std::max(std::sqrt(length2), 1e-12));
    double expected = prior.beta[0];
    const double *beta = prior.beta + 4;
    for (int i = 0; i < 3; i++) {
        expected += prior.beta[1 + i] * shrink * z[i];
        for (int j = 0; j <= i; j++) expected += *beta++ * shrink * z[i] * shrink * z[j];
    }
    return expected;
}

}  // namespace lensprof
