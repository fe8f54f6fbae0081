#pragma once

#include <vector>

namespace lensprof {

// The median, the upper one of two middle values; 0 without values.
double median(std::vector<double> values);

}  // namespace lensprof
