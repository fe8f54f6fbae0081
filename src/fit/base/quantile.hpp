// Quantiles of unordered values.
#pragma once

#include <algorithm>
#include <vector>

namespace lensprof {

// Value at a share 0..1 of the values in order, the lower one of two; the values change places. 0 of none.
template <class Value>
Value quantile(std::vector<Value> &values, double share) {
    if (values.empty()) return Value{};
    auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

template <class Value>
Value median(std::vector<Value> &values) {
    return quantile(values, 0.5);
}

}  // namespace lensprof
