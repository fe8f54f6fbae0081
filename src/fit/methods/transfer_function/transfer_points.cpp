#include "fit/methods/transfer_function/transfer_points.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/constants.hpp"
#include "fit/base/parallel.hpp"
#include "fit/base/quantile.hpp"
#include "fit/methods/transfer_function/joint_histogram.hpp"
#include "fit/problem/residual.hpp"

namespace lensprof {
namespace {

constexpr double kSmoothing = 1.5;      // bins: noise of neighbouring pictures
constexpr double kPathSmoothing = 2.0;  // bins: smooths the path's steps
constexpr int kLevels = 256;
constexpr double kNear = 4.0;            // sigmas of the noise within which a pair belongs to the curve
constexpr double kSmallestNoise = 0.25;  // levels: that of rounding
constexpr double kEnds = 2.0;  // sigmas from black and white within which the mean of the remaining pairs is biased

// Fewer and wider bins for sparse pairs; data deeper than 8 bit fall into bins of 8 bit.
int bins_for(size_t pairs) {
    return pairs >= 4000 ? kLevels : pairs >= 500 ? kLevels / 2 : pairs >= 100 ? kLevels / 4 : kLevels / 8;
}

// Moves a grey value's irradiance by a ratio, under the current response.
double evened(const Estimate &estimate, double value, double ratio) {
    double x = lensprof_response_invert(&estimate.fixed, value, nullptr);
    return lensprof_response_eval(&estimate.fixed, x * ratio, nullptr);
}

// Levels of the pairs of an edge in one channel, as both ends would have recorded them at the geometric mean of their
// falloffs. Leaves out pairs without a value between black and white.
std::vector<LevelPair> levels_of(const Problem &problem, const Estimate &estimate, const Edge &edge, int channel) {
    std::vector<LevelPair> levels;
    const size_t curve = problem.vignettings == 3 ? static_cast<size_t>(channel) : 0;
    const lensprof_vignetting &vignetting = estimate.vignetting[0][curve];  // of the only setting
    bool has_falloff = vignetting.k[0] != 0.0 || vignetting.k[1] != 0.0 || vignetting.k[2] != 0.0;
    for (size_t p = edge.first; p < edge.last; p++) {
        const auto &pair = problem.pairs[p];
        double value[2] = {pair.value[0][channel], pair.value[1][channel]};
        if (std::max(value[0], value[1]) >= 1.0 || std::min(value[0], value[1]) <= 0.0) continue;
        if (has_falloff) {
            double root = std::sqrt(falloff(problem, estimate, curve, pair).ratio);
            value[0] = evened(estimate, value[0], 1.0 / root);
            value[1] = evened(estimate, value[1], root);
            if (std::max(value[0], value[1]) >= 1.0) continue;
        }
        levels.push_back({255.0 * value[0], 255.0 * value[1]});
    }
    return levels;
}

// T as a function of levels: the path with its steps smoothed.
struct SmoothTransfer {
    std::array<double, kLevels> to;

    SmoothTransfer(const JointHistogram &histogram, const TransferPath &path) {
        auto reach = static_cast<int>(3 * kPathSmoothing);
        for (int i = 0; i < kLevels; i++) {
            double centre = histogram.bin(i), sum = 0.0, weights = 0.0;
            for (int b = static_cast<int>(centre) - reach; b <= static_cast<int>(centre) + reach + 1; b++) {
                double z = (b - centre) / kPathSmoothing, weight = std::exp(-0.5 * z * z);
                // Beyond the ends the path continues as its mirror image.
                int last = histogram.bins - 1, inside = b < 0 ? -b : b > last ? 2 * last - b : b;
                double value = path.to[static_cast<size_t>(inside)];
                sum += weight * (b < 0 ? -value : b > last ? 2 * last - value : value);
                weights += weight;
            }
            to[static_cast<size_t>(i)] = histogram.level(sum / weights);
        }
    }

    double at(double level, double &slope) const {
        auto i = static_cast<size_t>(std::clamp(level, 0.0, kLevels - 1.001));
        slope = to[i + 1] - to[i];
        return to[i] + (level - static_cast<double>(i)) * slope;
    }
};

// A pair near the curve: the position along the curve of its nearest point (the sum of both levels, which resolves a
// steep curve as finely as a flat one), and its distance.
struct PathPosition {
    double along;
    double distance;
};

PathPosition nearest_on_path(const SmoothTransfer &transfer, const LevelPair &pair) {
    double foot = pair[0], slope = 1.0, off = 0.0;
    for (int step = 0; step < 4; step++) {
        off = pair[1] - transfer.at(foot, slope);
        double next = foot + ((pair[0] - foot) + slope * off) / (1.0 + slope * slope);
        foot = std::clamp(0.5 * (foot + next), 0.0, kLevels - 1.0);
    }
    off = pair[1] - transfer.at(foot, slope);
    double distance = (off - slope * (pair[0] - foot)) / std::sqrt(1.0 + slope * slope);
    return {foot + transfer.at(foot, slope), distance};
}

// Mean of the pairs whose nearest points of the path are close together, without pairs off the curve. Distances are
// across the curve and not along an axis, so that noise in both values does not tilt it. Leaves out pairs near the ends
// of `range`.
void add_means(const SmoothTransfer &transfer, const std::vector<LevelPair> &pairs, bool is_swapped, double reach,
               const double range[2], TransferCurve &curve) {
    std::vector<PathPosition> positions;
    std::vector<double> distances;
    for (const LevelPair &pair : pairs) {
        positions.push_back(nearest_on_path(transfer, pair));
        if (std::abs(positions.back().distance) < reach) distances.push_back(std::abs(positions.back().distance));
    }
    if (distances.empty()) return;
    double noise = std::max(kMadToSigma * median(distances), kSmallestNoise);
    struct Sum {
        double weight = 0.0, level[2] = {0.0, 0.0};
    };
    std::array<Sum, 2 * kLevels> sums;
    for (size_t p = 0; p < pairs.size(); p++) {
        double z = positions[p].distance / (kNear * noise);
        if (std::abs(z) >= 1.0) continue;
        double weight = (1.0 - z * z) * (1.0 - z * z);
        Sum &sum = sums[static_cast<size_t>(std::clamp(std::lround(positions[p].along), 0l, 2l * kLevels - 1))];
        sum.weight += weight;
        for (size_t side = 0; side < 2; side++) sum.level[side] += weight * pairs[p][side];
    }
    for (const Sum &sum : sums) {
        if (sum.weight < 0.5) continue;
        double first = sum.level[0] / sum.weight, second = sum.level[1] / sum.weight;
        if (std::min(first, second) < range[0] + kEnds * noise || std::max(first, second) > range[1] - kEnds * noise)
            continue;
        if (is_swapped) std::swap(first, second);
        curve.points.push_back({{first, second}, 0.5 * sum.weight});  // half: the other direction repeats it
    }
    curve.noise = std::max(curve.noise, noise);
}

// The path's own points, as far as pairs support them.
void add_path(const JointHistogram &likelihood, const TransferPath &path, bool is_swapped, TransferCurve &curve) {
    double nothing = *std::min_element(likelihood.count.begin(), likelihood.count.end());
    for (int b = 1; b < likelihood.bins - 1; b++) {
        int to = path.to[static_cast<size_t>(b)];
        if (likelihood.at(b, to) <= nothing || to <= 0 || to >= likelihood.bins - 1) continue;
        double first = likelihood.level(b), second = likelihood.level(to);
        if (is_swapped) std::swap(first, second);
        curve.points.push_back({{first, second}, 1.0});
    }
}

TransferCurve transfer_curve(const Problem &problem, const Estimate &estimate, size_t edge, int channel,
                             const double range[2], bool as_paper) {
    TransferCurve curve{edge, channel, 0.0, {}};
    std::vector<LevelPair> pairs = levels_of(problem, estimate, problem.edges[edge], channel);
    if (pairs.empty()) return curve;
    JointHistogram histogram = joint_histogram(pairs, as_paper ? kLevels : bins_for(pairs.size()));
    JointHistogram likelihood = log_likelihood(histogram, kSmoothing);
    double reach = 2.0 * kNear * std::max(1.0, 255.0 / (histogram.bins - 1));
    for (bool is_swapped : {false, true}) {
        if (is_swapped) {
            likelihood = transposed(likelihood);
            for (LevelPair &pair : pairs) std::swap(pair[0], pair[1]);
        }
        TransferPath path = most_likely_path(likelihood);
        if (as_paper)
            add_path(likelihood, path, is_swapped, curve);
        else
            add_means(SmoothTransfer(histogram, path), pairs, is_swapped, reach, range, curve);
    }
    return curve;
}

}  // namespace

std::vector<TransferCurve> transfer_curves(const Problem &problem, const Estimate &estimate, bool as_paper) {
    double range[2] = {255.0, 0.0};  // of all grey levels: the sampler or the camera clips values beyond it
    for (const auto &pair : problem.pairs)
        for (const auto &side : pair.value)
            for (int c = 0; c < problem.channels; c++) {
                range[0] = std::min(range[0], 255.0 * side[c]);
                range[1] = std::max(range[1], 255.0 * side[c]);
            }
    auto channels = static_cast<size_t>(problem.channels);
    std::vector<TransferCurve> curves(problem.edges.size() * channels);
    for_each_parallel(
        static_cast<uint32_t>(curves.size()), problem.threads,
        [&](uint32_t k) {
            curves[k] =
                transfer_curve(problem, estimate, k / channels, static_cast<int>(k % channels), range, as_paper);
        },
        [] { return false; });
    return curves;
}

}  // namespace lensprof
