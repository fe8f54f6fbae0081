#include "fit/verdict/evenness.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fit/base/quantile.hpp"
#include "fit/problem/residual.hpp"
#include "fit/verdict/limits.hpp"

namespace lensprof {
namespace {

constexpr size_t kMinPairs = 20;  // of a link that is informative

// For every pair, in their order: mean over the channels.
std::vector<Seam> seams_of(const Problem &problem, const Estimate &estimate) {
    std::vector<Seam> seams(problem.pairs.size());
    for_each_transfer(problem, estimate, [&](size_t p, const PairTransfer &t) {
        const auto &pair = problem.pairs[p];
        for (size_t c = 0; c < static_cast<size_t>(problem.channels); c++) {
            const Transfer &transfer = t.channel[c];
            seams[p].before += 255.0 * std::abs(pair.value[0][c] - pair.value[1][c]) / problem.channels;
            seams[p].after +=
                255.0 * 0.5 * (std::abs(transfer.residual[0]) + std::abs(transfer.residual[1])) / problem.channels;
        }
    });
    return seams;
}

Seam median_of(const std::vector<Seam> &seams, size_t first, size_t last) {
    std::vector<double> before, after;
    for (size_t p = first; p < last; p++) before.push_back(seams[p].before), after.push_back(seams[p].after);
    return {median(before), median(after)};
}

bool is_even(const Seam &seam, double noise_levels) {
    return seam.after <= std::clamp(kOfNoise * noise_levels, kEven, kMaxNoise)
           || (seam.after <= kMuchLess * seam.before && seam.after <= kUneven);
}

// The first link that looks worse after the correction, or keeps a seam that the other links do not have.
std::optional<Seam> worst_link(const Problem &problem, const std::vector<Seam> &seams, double noise_levels) {
    const double max_residual = std::max(kOddLink, kOddNoise * noise_levels);
    for (const Edge &edge : problem.edges) {
        if (edge.last - edge.first < kMinPairs) continue;
        const Seam seam = median_of(seams, edge.first, edge.last);
        if (seam.after > std::max(kGrown * seam.before, kSeen)
            || (seam.after > max_residual && seam.after > kMuchLess * seam.before))
            return seam;
    }
    return std::nullopt;
}

}  // namespace

Seam judge_evenness(const Found &found, FitResult &r) {
    const std::vector<Seam> tested = seams_of(found.tested, found.train);
    const Seam overall = median_of(tested, 0, tested.size());
    const std::optional<Seam> worst =
        worst_link(found.problem, seams_of(found.problem, found.estimate), r.noise_levels);
    r.equalizes = r.converged && r.inlier_share > kEvenShare && is_even(overall, r.noise_levels) && !worst;
    return worst.value_or(overall);
}

}  // namespace lensprof
