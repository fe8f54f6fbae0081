// Quantiles of unordered values.
#pragma once

#include <algorithm>
#include <vector>

namespace lensprof {

// The value at quantile `share` (0..1), the lower of two candidates; reorders the values. 0 if there are no values.
template <class Value>
Value quantile(std::vector<Value> &values, double share) {
    if (values.empty()) return Value{};
    auto position = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), position, values.end());
    return *position;
}

template <class Value>
Value median(std::vector<Value> &values) {
    return quantile(values, 0.5);
}

}  // namespace lensprof
