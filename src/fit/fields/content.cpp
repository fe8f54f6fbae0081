#include "fit/fields/content.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"
#include "fit/fields/cells.hpp"

namespace lensprof {
namespace {

constexpr double kSmallestSigma = 2e-3;  // of a component: error of a cell that is not noise
constexpr double kBackgroundShare = 0.05;
constexpr double kTiny = 1e-12;  // density where no component reaches

}  // namespace

void Content::start(const std::vector<float> &values) {
    std::vector<float> finite = finite_of(values);
    const double spread = std::max(0.5 * static_cast<double>(quantile(finite, 0.84) - quantile(finite, 0.16)), 1e-3);
    for (size_t k = 0; k < kComponents; k++) {
        share_[k] = 1.0 / kComponents;
        mean_[k] = static_cast<double>(quantile(finite, (static_cast<double>(k) + 0.5) / kComponents));
        sigma_[k] = 0.5 * spread;
    }
}

Content::Each Content::probabilities(double value) const {
    Each p;
    for (size_t k = 0; k < kComponents; k++) {
        const double z = (value - mean_[k]) / sigma_[k];
        p[k] = share_[k] * std::exp(-0.5 * z * z) / sigma_[k];
    }
    return p;
}

void Content::fit(const std::vector<float> &values, int rounds) {
    float low = INFINITY, high = -INFINITY;
    for (float value : values)
        if (!std::isnan(value)) low = std::min(low, value), high = std::max(high, value);
    low_ = static_cast<double>(low), scale_ = (kEntries - 1.0) / std::max(static_cast<double>(high - low), 1e-9);
    std::vector<double> count(kEntries);
    for (float value : values)
        if (!std::isnan(value))
            count[static_cast<size_t>(std::lround((static_cast<double>(value) - low_) * scale_))] += 1.0;
    for (int round = 0; round < rounds; round++) {
        Each sum{}, first{}, second{};
        double total = 0.0;
        for (size_t i = 0; i < kEntries; i++) {
            if (count[i] == 0.0) continue;
            const double value = low_ + static_cast<double>(i) / scale_;
            const Each p = probabilities(value);
            double density = kTiny;
            for (double one : p) density += one;
            for (size_t k = 0; k < kComponents; k++) {
                const double part = count[i] * p[k] / density, away = value - mean_[k];
                sum[k] += part, first[k] += part * away, second[k] += part * away * away;
            }
            total += count[i];
        }
        for (size_t k = 0; k < kComponents; k++) {
            const double parts = sum[k] + 1e-9, shift = first[k] / parts;
            share_[k] = parts / (total + kComponents * 1e-9);
            mean_[k] += shift;
            sigma_[k] = std::max(std::sqrt(std::max(second[k] / parts - shift * shift, 0.0)), kSmallestSigma);
        }
    }
    tabulate();
}

void Content::tabulate() {
    table_.resize(kEntries);
    for (size_t i = 0; i < kEntries; i++) {
        const double value = low_ + static_cast<double>(i) / scale_;
        const Each p = probabilities(value);
        double density = kTiny;
        for (double one : p) density += one;
        Pull pull{0.0, 0.0, -std::log(density / std::sqrt(2.0 * kPi))};
        for (size_t k = 0; k < kComponents; k++) {
            const double weight = p[k] / density / (sigma_[k] * sigma_[k]);
            pull.weight += weight, pull.force += weight * (value - mean_[k]);
        }
        table_[i] = pull;
    }
}

size_t Content::narrowest() const {
    size_t best = kComponents;
    for (size_t k = 0; k < kComponents; k++)
        if (share_[k] >= kBackgroundShare && (best == kComponents || sigma_[k] < sigma_[best])) best = k;
    return best == kComponents ? 0 : best;
}

double Content::narrowest_share() const { return share_[narrowest()]; }
double Content::narrowest_sigma() const { return sigma_[narrowest()]; }

}  // namespace lensprof
