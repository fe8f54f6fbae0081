#pragma once

#include <vector>

namespace lensprof {

// The upper one of two in the middle; 0 of no values.
double median(std::vector<double> values);

}  // namespace lensprof
