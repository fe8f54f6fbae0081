// Quantiles of unordered values, and of chi-squared.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lensprof {

// The value that would stand at a place if the values were sorted; reorders them. Quickselect whose partitions have no
// branches to predict (Lomuto's, each value swapped): three times as fast as std::nth_element for the values of a cell.
template <class Value>
Value select(Value *values, size_t count, size_t place, int rounds = 40) {
    const auto move_to_front = [&](const auto &belongs) {
        size_t front = 0;
        for (size_t i = 0; i < count; i++) {
            const Value value = values[i];
            values[i] = values[front], values[front] = value;
            front += belongs(value) ? 1 : 0;
        }
        return front;
    };
    for (int round = 0; count > 1 && round < rounds; round++) {  // bad pivots are left to std::nth_element
        const Value a = values[0], b = values[count / 2], c = values[count - 1];
        const Value pivot = std::max(std::min(a, b), std::min(std::max(a, b), c));
        size_t front = move_to_front([=](Value value) { return value < pivot; });
        if (front == 0) {  // the pivot is the smallest value, and may be all of them
            front = move_to_front([=](Value value) { return value <= pivot; });
            if (place < front) return pivot;
        }
        if (place < front) {
            count = front;
        } else {
            values += front, count -= front, place -= front;
        }
    }
    std::nth_element(values, values + place, values + count);
    return values[place];
}

// The value at quantile `share` (0..1), the lower of two candidates; reorders the values. 0 if there are no values.
template <class Value>
Value quantile(std::vector<Value> &values, double share) {
    if (values.empty()) return Value{};
    return select(values.data(), values.size(), static_cast<size_t>(share * static_cast<double>(values.size() - 1)));
}

template <class Value>
Value median(std::vector<Value> &values) {
    return quantile(values, 0.5);
}

// The median, the upper one of two middle values; 0 without values.
template <class Value>
Value upper_median(std::vector<Value> values) {
    if (values.empty()) return Value{};
    return select(values.data(), values.size(), values.size() / 2);
}

// The 99 % quantile of chi-squared, by Wilson and Hilferty (1931).
inline double chi_squared_limit(int freedom) {
    constexpr double kOneIn = 2.33;  // standard deviations that a normal variable exceeds with probability 1 %
    const double share = 2.0 / (9.0 * freedom), root = 1.0 - share + kOneIn * std::sqrt(share);
    return freedom * root * root * root;
}

}  // namespace lensprof
