// Where most of some values lie, although many may be outliers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace lensprof {

constexpr double kTukey = 3.5;  // standard deviations at which a value has no influence

// Middle and standard deviation of the narrowest interval with a third of the values, as that of a normal
// distribution: two thirds may be outliers.
inline std::pair<double, double> narrowest_third(const std::vector<float> &values) {
    constexpr size_t most_sorted = 2048;
    constexpr double half_width = 0.4307;  // of a third of a normal distribution, standard deviations
    std::vector<float> sorted;
    const size_t step = values.size() / most_sorted + 1;
    for (size_t n = 0; n < values.size(); n += step) sorted.push_back(values[n]);
    std::sort(sorted.begin(), sorted.end());
    const size_t third = sorted.size() / 3;
    size_t best = 0;
    for (size_t n = 1; n + third < sorted.size(); n++)
        if (sorted[n + third] - sorted[n] < sorted[best + third] - sorted[best]) best = n;
    const auto low = static_cast<double>(sorted[best]), high = static_cast<double>(sorted[best + third]);
    return {(low + high) / 2.0, (high - low) / 2.0 / half_width};
}

struct Location {
    double middle, spread;
    size_t inside;  // values with influence
};

// Mode of the values, of which there is one or more: from the narrowest third, by Tukey's biweight, whose scale follows
// what is inside and is at least `narrowest`.
inline Location locate(const std::vector<float> &values, const std::vector<float> &weight, double narrowest) {
    constexpr double biweight = 1.1853;  // standard deviation of a normal distribution over that of its weighted values
    auto [middle, spread] = narrowest_third(values);
    spread = std::max(spread, narrowest);
    size_t inside = 0;
    for (int round = 0; round < 12; round++) {
        const double limit = kTukey * spread;
        double sum = 0.0, weights = 0.0, squares = 0.0, plain = 0.0;
        inside = 0;
        for (size_t n = 0; n < values.size(); n++) {
            const double residual = static_cast<double>(values[n]) - middle, share = residual / limit;
            if (std::abs(share) >= 1.0) continue;
            const double tail = 1.0 - share * share, influence = static_cast<double>(weight[n]) * tail * tail;
            sum += influence * residual, weights += influence;
            squares += influence * residual * residual, plain += influence;
            inside++;
        }
        if (!(weights > 0.0)) break;
        const double step = sum / weights;
        middle += step;
        spread = std::max(biweight * std::sqrt(squares / plain), narrowest);
        if (std::abs(step) < 1e-6 && round > 2) break;
    }
    return {middle, spread, inside};
}

}  // namespace lensprof
