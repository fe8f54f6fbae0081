// The exponent gamma that a response has by measure of its shape.
//
// A response's family f(x^(1/gamma)) is one shape. Measured cameras of one shape have similar exponents: the position
// of a curve within its family, the logarithm of ln g(0.35) / ln 0.08, follows from the curve's values at three
// irradiances of the member with f(0.08) = 0.35, by a quadratic fitted to the DoRF database
// (profiles/tools/make_gamma_prior.py).
#pragma once

#include <lensprof/fit.h>

namespace lensprof {

constexpr double kGaugeGrey = 0.35;

struct GammaPrior {
    double sigma;         // standard error of ln gamma: 68 % of curves left out are nearer
    double mean[3];       // of the shape
    double whiten[3][3];  // shape minus mean, to unit covariance
    double beta[10];      // 1, z0, z1, z2, z0 z0, z1 z0, z1 z1, z2 z0, z2 z1, z2 z2
};

const GammaPrior &gamma_prior(uint32_t camera_kind);

// Position of a response table within its family, ln gamma from the member with f(0.08) = 0.35.
double gamma_position(const double *table);

// The position that the prior expects of a curve of this shape.
double expected_position(const GammaPrior &prior, const double *table);

}  // namespace lensprof
