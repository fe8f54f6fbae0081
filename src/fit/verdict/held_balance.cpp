#include "fit/verdict/held_balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"
#include "fit/problem/residual.hpp"
#include "fit/verdict/limits.hpp"

namespace lensprof {
namespace {

constexpr size_t kMinBalancePairs = 30;  // of a link
constexpr double kMedianError = 1.2533;  // sqrt(pi / 2): standard error of a median relative to that of a mean

bool is_held(const Problem &problem, uint32_t image, size_t channel) {
    return image != problem.reference && problem.balance_unknown[image][channel] < 0;
}

// Sum of the differences of an image from its neighbours.
struct Sum {
    double levels = 0.0, variance = 0.0, links = 0.0;

    void add(double difference, double error) { levels += difference, variance += error * error, links += 1.0; }
    double mean() const { return links > 0.0 ? std::abs(levels) / links : 0.0; }
    bool is_clear() const { return mean() > kClearLevels && std::abs(levels) > kClearBalance * std::sqrt(variance); }
};

// For red (k = 0) or blue (1).
HeldBalance held_balance_of(const Problem &problem, size_t k,
                            const std::vector<std::array<double, 2>> &relative_to_green) {
    std::vector<Sum> sums(problem.image_count);
    for (const Edge &edge : problem.edges) {
        if (edge.last - edge.first < kMinBalancePairs) continue;
        std::vector<double> values, distances;
        for (size_t p = edge.first; p < edge.last; p++) values.push_back(relative_to_green[p][k]);
        const double middle = median(values);
        for (const double value : values) distances.push_back(std::abs(value - middle));
        const double error =
            kMedianError * kMadToSigma * median(distances) / std::sqrt(static_cast<double>(values.size()));
        sums[edge.image[0]].add(-middle, error);
        sums[edge.image[1]].add(middle, error);
    }
    HeldBalance found;
    for (uint32_t i = 0; i < problem.image_count; i++)
        if (is_held(problem, i, 2 * k) && sums[i].is_clear() && sums[i].mean() > found.levels)
            found = {sums[i].mean(), i};
    return found;
}

}  // namespace

HeldBalance held_balance(const Problem &problem, const Estimate &estimate) {
    if (problem.channels != 3) return {};
    std::vector<std::array<double, 2>> relative_to_green(problem.pairs.size());  // red, blue
    for_each_transfer(problem, estimate, [&](size_t p, const PairTransfer &t) {
        for (size_t k = 0; k < 2; k++)
            relative_to_green[p][k] = 255.0 * (t.channel[2 * k].residual[0] - t.channel[1].residual[0]);
    });
    const HeldBalance red = held_balance_of(problem, 0, relative_to_green),
                      blue = held_balance_of(problem, 1, relative_to_green);
    return red.levels > blue.levels ? red : blue;
}

}  // namespace lensprof
