// Quantiles of unordered values, and of chi-squared.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
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

// The median, the upper one of two middle values; 0 without values.
template <class Value>
Value upper_median(std::vector<Value> values) {
    if (values.empty()) return Value{};
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// The 99 % quantile of chi-squared, by Wilson and Hilferty (1931).
inline double chi_squared_limit(int freedom) {
    constexpr double kOneIn = 2.33;  // standard deviations that a normal variable exceeds with probability 1 %
    const double share = 2.0 / (9.0 * freedom), root = 1.0 - share + kOneIn * std::sqrt(share);
    return freedom * root * root * root;
}

}  // namespace lensprof
