#include "fit/methods/transfer_function/joint_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lensprof {
namespace {

constexpr double kImpossible = -std::numeric_limits<double>::infinity();

// Convolves along rows: row r, element k at values[r * across + k * along].
void smooth_rows(std::vector<double> &values, int bins, size_t across, size_t along,
                 const std::vector<double> &kernel) {
    auto reach = static_cast<int>(kernel.size()) - 1;
    std::vector<double> row(static_cast<size_t>(bins));
    for (size_t r = 0; r < row.size(); r++) {
        std::fill(row.begin(), row.end(), 0.0);
        for (int k = 0; k < bins; k++) {
            double value = values[r * across + static_cast<size_t>(k) * along];
            if (value == 0.0) continue;
            for (int to = std::max(k - reach, 0); to <= std::min(k + reach, bins - 1); to++)
                row[static_cast<size_t>(to)] += value * kernel[static_cast<size_t>(std::abs(to - k))];
        }
        for (size_t k = 0; k < row.size(); k++) values[r * across + k * along] = row[k];
    }
}

// The best path on one side of the identity: best[b2] is the best of all paths that end at (b1, b2).
TransferPath path_on_side(const JointHistogram &likelihood, bool above) {
    const int bins = likelihood.bins;
    std::vector<double> best(static_cast<size_t>(bins), kImpossible), next = best;
    std::vector<uint16_t> came_from(likelihood.count.size());
    best[0] = likelihood.at(0, 0);
    for (int b1 = 1; b1 < bins; b1++) {
        int from = 0;  // end of the best of all lower paths; of equal ones the nearest
        for (int b2 = 0; b2 < bins; b2++) {
            if (best[static_cast<size_t>(b2)] >= best[static_cast<size_t>(from)]) from = b2;
            bool allowed = above ? b2 >= b1 : b2 <= b1;
            next[static_cast<size_t>(b2)] =
                allowed ? best[static_cast<size_t>(from)] + likelihood.at(b1, b2) : kImpossible;
            came_from[static_cast<size_t>(b1 * bins + b2)] = static_cast<uint16_t>(from);
        }
        best.swap(next);
    }
    TransferPath path{std::vector<int>(static_cast<size_t>(bins), bins - 1), best[static_cast<size_t>(bins - 1)]};
    for (int b1 = bins - 1; b1 > 0; b1--)
        path.to[static_cast<size_t>(b1 - 1)] =
            came_from[static_cast<size_t>(b1 * bins + path.to[static_cast<size_t>(b1)])];
    return path;
}

}  // namespace

JointHistogram joint_histogram(const std::vector<LevelPair> &pairs, int bins) {
    JointHistogram histogram{bins, std::vector<double>(static_cast<size_t>(bins * bins), 0.0)};
    for (const LevelPair &pair : pairs) {
        int b[2];
        for (size_t side = 0; side < 2; side++)
            b[side] = std::clamp(static_cast<int>(std::lround(histogram.bin(pair[side]))), 0, bins - 1);
        histogram.count[static_cast<size_t>(b[0] * bins + b[1])] += 1.0;
    }
    return histogram;
}

JointHistogram log_likelihood(const JointHistogram &histogram, double sigma) {
    JointHistogram result = histogram;
    double total = 0.0, sum = 0.0;
    for (double count : histogram.count) total += count;
    std::vector<double> kernel;
    for (int k = 0; k <= static_cast<int>(std::ceil(3.0 * sigma)); k++) {
        kernel.push_back(std::exp(-0.5 * k * k / (sigma * sigma)));
        sum += (k ? 2.0 : 1.0) * kernel.back();
    }
    for (double &k : kernel) k /= sum;
    auto bins = static_cast<size_t>(histogram.bins);
    smooth_rows(result.count, histogram.bins, bins, 1, kernel);
    smooth_rows(result.count, histogram.bins, 1, bins, kernel);
    double floor = std::max(total, 1.0) / static_cast<double>(histogram.count.size());
    for (double &count : result.count) count = std::log(count + floor);
    return result;
}

JointHistogram transposed(const JointHistogram &histogram) {
    JointHistogram result = histogram;
    for (int b1 = 0; b1 < histogram.bins; b1++)
        for (int b2 = 0; b2 < histogram.bins; b2++)
            result.count[static_cast<size_t>(b2 * histogram.bins + b1)] = histogram.at(b1, b2);
    return result;
}

TransferPath most_likely_path(const JointHistogram &log_likelihood) {
    TransferPath above = path_on_side(log_likelihood, true), below = path_on_side(log_likelihood, false);
    return above.log_likelihood >= below.log_likelihood ? above : below;
}

}  // namespace lensprof
