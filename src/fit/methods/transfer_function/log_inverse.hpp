// The logarithm of the inverse response, g(I) = ln f^-1(I), by its principal components over measured cameras
// (Kim & Pollefeys 2004, eq. 8): g = g0 + sum c_n h'_n at the grey levels I = 1..255 of 255.
#pragma once

#include <array>

#include <Eigen/Core>

#include <lensprof/model.h>

namespace lensprof {

constexpr int kLogModes = 25, kLogLevels = 255;

// Row 0 is g0, row n is h'_n, orthonormal; and the spread of the coefficients over the database (log_emor_table.cpp).
extern const double kLogEmor[1 + kLogModes][kLogLevels];
extern const double kLogEmorSigma[kLogModes];
extern const double kLogEmorVariance;  // of g about g0, summed over the levels

// g at the levels 1..255; [0] is level 1, and g(255) = 0.
using LogInverse = std::array<double, kLogLevels>;

using LogCoefficients = Eigen::Matrix<double, kLogModes, 1>;  // zero beyond the modes in use

LogInverse log_inverse(const LogCoefficients &c);
LogInverse log_inverse(const lensprof_response &response);

// Interpolates a row of levels 1..255 at a grey level, and its slope per level.
double at_level(const double *row, double level, double *slope);

// f on the grid of irradiance: the inverse of exp g, linear between levels and starting from 0 at level 0.
lensprof_response response_of(const LogInverse &g);

// Smallest rise of g from one level to the next.
constexpr double kSmallestLogRise = 1e-5;

// Minimises  1/2 c'Sc - b'c  over the first b.size() coefficients, subject to g rising from level to level; NaN if S is
// not positive definite.
LogCoefficients monotone_coefficients(const Eigen::MatrixXd &S, const Eigen::VectorXd &b);

}  // namespace lensprof
