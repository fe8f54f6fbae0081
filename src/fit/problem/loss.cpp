#include "fit/problem/loss.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {
namespace {

constexpr double kSmallestNoise = 0.05 / 255.0;  // below this, quantisation of 8-bit data still leaves errors

}  // namespace

PairWeights pair_weights(const PairTransfer &transfer, int channels, const Loss &loss) {
    if (loss.kind != LENSPROF_LOSS_ROBUST) return {{{1.f, 1.f}, {1.f, 1.f}, {1.f, 1.f}}};
    PairWeights weights{};
    for (int c = 0; c < channels; c++)
        for (int side = 0; side < 2; side++) {
            double by_value = transfer.channel[c].by_value[side];
            weights[c][side] = static_cast<float>(1.0 / std::sqrt(1.0 + by_value * by_value));
        }
    return weights;
}

NoiseWeights noise_weights(const Problem &problem, const Estimate &estimate, const Loss &loss) {
    NoiseWeights weights(problem.pairs.size(), {{{1.f, 1.f}, {1.f, 1.f}, {1.f, 1.f}}});
    if (loss.kind != LENSPROF_LOSS_ROBUST) return weights;
    for_each_chunk(problem, [&](uint32_t k) {
        for_each_transfer(problem, problem.chunks[k], estimate, [&](size_t p, const PairTransfer &t) {
            weights[p] = pair_weights(t, problem.channels, loss);
        });
    });
    return weights;
}

PairResiduals weighted_residuals(const PairTransfer &transfer, int channels, const PairWeights &weights) {
    PairResiduals residuals{};
    for (int c = 0; c < channels; c++)
        for (int side = 0; side < 2; side++) residuals[c][side] = transfer.channel[c].residual[side] * weights[c][side];
    return residuals;
}

double pair_chi2(const PairResiduals &residuals, int channels, double noise) {
    double sum = 0.0;
    for (int c = 0; c < channels; c++)
        for (double r : residuals[c]) sum += r * r;
    return 0.5 * sum / (noise * noise);  // half: both directions measure the same
}

double robust_cost(double z, double c2, double *divisor) {
    double q = z / c2;
    *divisor = 1.0 + q * q;
    return c2 * std::atan(q);
}

double pair_cost(const PairResiduals &residuals, int channels, const Loss &loss, PairResiduals *weights) {
    double scale = 0.5 / (loss.noise * loss.noise);
    if (loss.kind == LENSPROF_LOSS_ROBUST) {
        double c2 = loss.cutoff * loss.cutoff * channels, z = pair_chi2(residuals, channels, loss.noise), divisor;
        double cost = robust_cost(z, c2, &divisor), weight = scale / divisor;
        if (weights)
            for (auto &channel : *weights) channel = {weight, weight};
        return cost;
    }
    double cost = 0.0;
    for (int c = 0; c < channels; c++)
        for (int side = 0; side < 2; side++) {
            double e = std::abs(residuals[c][side]), sigma = loss.huber;
            bool quadratic = loss.kind == LENSPROF_LOSS_SQUARED || e < sigma;
            cost += scale * (quadratic ? e * e : 2.0 * sigma * e - sigma * sigma);
            if (weights) (*weights)[c][side] = scale * (quadratic ? 1.0 : sigma / e);
        }
    return cost;
}

std::vector<double> all_chi2(const Problem &problem, const Estimate &estimate, double noise) {
    std::vector<double> z(problem.pairs.size());
    for_each_chunk(problem, [&](uint32_t k) {
        for_each_transfer(problem, problem.chunks[k], estimate, [&](size_t p, const PairTransfer &t) {
            PairResiduals residuals =
                weighted_residuals(t, problem.channels, pair_weights(t, problem.channels, Loss{}));
            z[p] = pair_chi2(residuals, problem.channels, noise);
        });
    });
    return z;
}

double inlier_limit(int channels) { return channels == 3 ? 14.2 : 9.0; }

double estimate_noise(const Problem &problem, const Estimate &estimate, double start) {
    std::vector<double> z = all_chi2(problem, estimate, 1.0);
    if (z.empty()) return start;
    // Starts from the 35 % quantile: with half the pairs wrong it is still a quantile (70 %) of the correct ones.
    size_t rank = z.size() * 35 / 100;
    std::nth_element(z.begin(), z.begin() + static_cast<std::ptrdiff_t>(rank), z.end());
    double quantile = problem.channels == 3 ? 1.642 : 0.206;  // chi-squared, 35 %, 3 and 1 degrees of freedom
    double variance = std::max(z[rank] / quantile, kSmallestNoise * kSmallestNoise);
    // Mean square of the inliers per degree of freedom; the truncation removes less than 3 %.
    for (int round = 0; round < 10; round++) {
        double sum = 0.0;
        size_t count = 0;
        for (double value : z)
            if (value < inlier_limit(problem.channels) * variance) sum += value, count++;
        if (!count) break;
        double next = sum / (static_cast<double>(count) * problem.channels);
        if (std::abs(next - variance) < 1e-6 * variance) break;
        variance = std::max(next, kSmallestNoise * kSmallestNoise);
    }
    return std::sqrt(variance);
}

}  // namespace lensprof
