// Constraints on the shape of a camera's curves: the response rises, the falloff stays positive.
#pragma once

#include <vector>

#include "fit/base/inequality.hpp"
#include "fit/problem/problem.hpp"

namespace lensprof {

// Smallest increase of f between two of its 1024 samples, 1/1000 of the mean increase: strictly invertible.
constexpr double kSmallestRise = 1e-6;
constexpr int kRises = LENSPROF_RESPONSE_SAMPLES - 1;

// Largest coordinate of a falloff's centre that a fit allows, half diagonals.
constexpr double kLargestCenter = 0.5;

// True if f, with this many modes, rises by at least half of kSmallestRise everywhere.
bool is_rising(const double *emor, int modes);

// True if M with these k1..k3 is positive wherever a frame with this centre can reach.
bool is_positive(const double *k, const double *center);

// Whether all curves satisfy both.
bool is_feasible(const Estimate &estimate, int vignettings);

// For each rise of f, how far the `modes` coefficients are from making it kSmallestRise; > 0: violated.
void rise_gaps(const double *emor, int modes, double *gaps);

// Increase of mode l (from 0) between samples j and j + 1: the derivative of that rise. The ends of f stay exactly 0
// and 1 (see lp_emor_curve).
double rise_of_mode(int l, int j);

// The monotone combination of the first `modes` modes nearest to a curve of 1024 samples.
std::vector<double> project_curve(const double *curve, int modes);

}  // namespace lensprof
