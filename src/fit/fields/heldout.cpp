#include "fit/fields/heldout.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "fit/base/parallel.hpp"

namespace lensprof {
namespace {

using Sums = Descent::Sums;

constexpr double kSmallestRest = 1e-9;  // of the weight of a cell
constexpr double kLessSmooth = 0.1;     // of the weight of the penalty
constexpr double kUnknownBias = 1.0;    // mean square of ln S: more than a usable shading has

Sums total_of(const std::vector<Sums> &groups) {
    Sums total = groups[0];
    for (size_t g = 1; g < groups.size(); g++)
        for (size_t j = 0; j < total.weight.size(); j++)
            total.weight[j] += groups[g].weight[j], total.weighted[j] += groups[g].weighted[j];
    return total;
}

// The surface of all groups but one, at the cells; empty if the rest does not determine it. The cells have their
// weights in all groups, so that one factorisation serves every group; their values are those of the rest.
std::vector<double> without(const Sums &total, const Sums &group, const Surface &surface,
                            const Surface::Solver &solver) {
    const size_t count = total.weight.size();
    std::vector<double> value(count), nodes;
    for (size_t j = 0; j < count; j++) {
        const double rest = total.weight[j] - group.weight[j];
        if (rest > kSmallestRest * total.weight[j])
            value[j] = (total.weighted[j] - group.weighted[j]) / rest;
        else if (total.weight[j] > 0.0)  // only this group has seen the cell
            value[j] = total.weighted[j] / total.weight[j];
    }
    if (!solver.solve(value, nodes)) return {};
    return surface.at_cells(nodes);
}

// Whether pictures of other groups have seen a cell of this one: its own value predicts it otherwise.
bool is_held_out(const Sums &total, const Sums &group, size_t j) {
    return group.weight[j] > 0.0 && total.weight[j] - group.weight[j] > kSmallestRest * total.weight[j];
}

// Weighted squared distance of a group's cells from a surface, whose level is free.
double distance(const Sums &total, const Sums &group, const std::vector<double> &predicted) {
    double sum = 0.0, first = 0.0, second = 0.0;
    for (size_t j = 0; j < predicted.size(); j++) {
        if (!is_held_out(total, group, j)) continue;
        const double away = group.weighted[j] / group.weight[j] - predicted[j];
        sum += group.weight[j], first += group.weight[j] * away, second += group.weight[j] * away * away;
    }
    return sum > 0.0 ? second - first * first / sum : 0.0;
}

}  // namespace

Smoothness smoothness_at(size_t index) {
    return {kSmoothOrders[index / kSmoothWeights], smooth_weight(static_cast<int>(index % kSmoothWeights))};
}

Heldout hold_out(const Descent &descent, const Surface &surface, size_t groups, uint32_t threads) {
    const std::vector<Sums> parts = descent.sums(groups);
    const Sums total = total_of(parts);
    double weights = 0.0;  // of the cells that are held out
    for (const Sums &group : parts)
        for (size_t j = 0; j < total.weight.size(); j++)
            if (is_held_out(total, group, j)) weights += group.weight[j];
    Heldout found;
    found.rms.assign(kSmoothnesses, INFINITY);
    for_each_parallel(
        kSmoothnesses, threads,
        [&](uint32_t i) {
            const auto solver = surface.solver(total.weight, smoothness_at(i));
            double sum = 0.0;
            for (const Sums &group : parts) {
                const std::vector<double> predicted = without(total, group, surface, *solver);
                sum += predicted.empty() ? INFINITY : distance(total, group, predicted);
            }
            found.rms[i] = std::sqrt(sum / std::max(weights, kSmallestRest));
        },
        [] { return false; });
    const auto best = static_cast<size_t>(std::min_element(found.rms.begin(), found.rms.end()) - found.rms.begin());
    found.best_index = best, found.best = smoothness_at(best), found.best_rms = found.rms[best];
    const std::vector<double> even(total.weight.size());
    double sum = 0.0;
    for (const Sums &group : parts) sum += distance(total, group, even);
    found.even_rms = std::sqrt(sum / std::max(weights, kSmallestRest));
    return found;
}

double smoothing_bias(const Descent &descent, const Surface &surface, size_t groups) {
    const std::vector<Sums> parts = descent.sums(groups);
    const Sums total = total_of(parts);
    Smoothness less = descent.smoothness;
    less.weight *= kLessSmooth;
    const auto chosen = surface.solver(total.weight, descent.smoothness), other = surface.solver(total.weight, less);
    std::vector<std::vector<double>> changes;  // without each group
    for (const Sums &group : parts) {
        const std::vector<double> smooth = without(total, group, surface, *chosen);
        std::vector<double> change = without(total, group, surface, *other);
        if (smooth.empty() || change.empty()) return kUnknownBias;
        for (size_t j = 0; j < change.size(); j++) change[j] -= smooth[j];
        changes.push_back(std::move(change));
    }
    double bias = 0.0;
    const auto count = static_cast<double>(groups);
    for (size_t j = 0; j < total.weight.size(); j++) {
        double mean = 0.0, square = 0.0;
        for (const auto &change : changes) mean += change[j] / count;
        for (const auto &change : changes) square += (change[j] - mean) * (change[j] - mean);
        bias += mean * mean - (count - 1.0) / count * square;
    }
    return std::max(bias / static_cast<double>(total.weight.size()), 0.0);
}

}  // namespace lensprof
