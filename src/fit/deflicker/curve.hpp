// Smooth curves through values in time.
#pragma once

#include <vector>

namespace lensprof {

double mean_of(const std::vector<double> &values);

// Local linear regression with tricube weights (Cleveland 1979), robust to single values; `window` before and after a
// point shapes its value. Times never decrease.
std::vector<double> smooth_curve(const std::vector<double> &times, const std::vector<double> &values, double window);

// The window that best predicts values left out: at least 30 steps of the mean length, or all.
double best_window(const std::vector<double> &times, const std::vector<double> &values);

}  // namespace lensprof
