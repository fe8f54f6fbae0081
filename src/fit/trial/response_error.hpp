// What is uncertain about the response of a candidate: its shape and its exponent gamma.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <lensprof/profile.h>

namespace lensprof {

constexpr size_t kErrorLevels = 256;
using LevelError = std::array<double, kErrorLevels>;  // of ln irradiance by grey value, equidistant in 0..1

struct ResponseError {
    std::vector<LevelError> shapes;  // independent, each by one standard deviation
    double log_gamma = 0.0;          // expected: ln of the response's exponent over the true one
    double log_gamma_sigma = 0.0;    // its standard error; 0: gamma is that of the falloff
};

// Shapes of a response whose EMoR coefficients have this covariance, times `share`. A change of gamma is not part of
// them: it is taken out by least squares over the grey values.
std::vector<LevelError> shape_errors(const lensprof_response &response, const Eigen::MatrixXd &covariance,
                                     double share);

// The error of a profile's own response, whose gamma is that of its falloff: by its covariance, or without one a share
// of the scatter of the kind of camera.
ResponseError own_error(const lensprof_profile &profile, uint32_t camera_kind);

// The error of the kind's typical response, or of that of another profile (NULL: the typical one) with a falloff that
// is not of the same fit.
ResponseError foreign_error(const lensprof_profile *profile, uint32_t camera_kind);

}  // namespace lensprof
