#include "fit/verdict/evenness.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fit/base/quantile.hpp"
#include "fit/problem/residual.hpp"
#include "fit/verdict/reason.hpp"

namespace lensprof {
namespace {

// Levels of 255.
constexpr double kEven = 2.0;     // between pictures that look alike,
constexpr double kOfNoise = 1.5;  // this much above the effect of noise,
constexpr double kMaxNoise = 4.0;
constexpr double kUneven = 6.0;   // and between those that do not
constexpr double kSeen = 3.0;     // a seam that is comparable to the texture around it,
constexpr double kGrown = 1.25;   // or this many times its size before;
constexpr double kOddLink = 5.0;  // of a link that contradicts the result, and this many times the noise,
constexpr double kOddNoise = 4.0;
constexpr double kGain = 0.5;  // unless it is at most this many times its size before
constexpr double kLargestRms = 15.0;
constexpr double kMinInlierShare = 0.6;  // of all pairs: with fewer, only part of the picture is even;
constexpr double kSmallestShare = 0.7;   // of the pairs that agree
constexpr size_t kMinPairs = 20;         // of a link that is informative

// Median difference of grey values, before and after the correction.
struct Seam {
    double before = 0.0, after = 0.0;
};

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
           || (seam.after <= kGain * seam.before && seam.after <= kUneven);
}

// The first link that looks worse after the correction, or keeps a seam that the other links do not have.
std::optional<Seam> odd_link(const Problem &problem, const std::vector<Seam> &seams, double noise_levels) {
    const double max_residual = std::max(kOddLink, kOddNoise * noise_levels);
    for (const Edge &edge : problem.edges) {
        if (edge.last - edge.first < kMinPairs) continue;
        const Seam seam = median_of(seams, edge.first, edge.last);
        if (seam.after > std::max(kGrown * seam.before, kSeen)
            || (seam.after > max_residual && seam.after > kGain * seam.before))
            return seam;
    }
    return std::nullopt;
}

// Verdicts on the profile that do not affect how even the pictures are.
bool is_of_profile(uint32_t reason) {
    switch (reason) {
    case LENSPROF_REASON_PATTERNS:
    case LENSPROF_REASON_PATTERNS_HELD:
    case LENSPROF_REASON_FEW_GREYS:
    case LENSPROF_REASON_EXPOSURES_ALIKE:
    case LENSPROF_REASON_SMALL_RADIUS: return true;
    default: return false;
    }
}

}  // namespace

void judge_evenness(const Found &found, FitResult &r) {
    r.evens = 0;
    if (!r.usable && !is_of_profile(r.reason_code)) return;
    const std::vector<Seam> tested = seams_of(found.tested, found.train);
    const Seam overall = median_of(tested, 0, tested.size());
    const std::optional<Seam> odd = odd_link(found.problem, seams_of(found.problem, found.estimate), r.noise_levels);
    r.evens = r.converged && r.inlier_share > kMinInlierShare && is_even(overall, r.noise_levels) && !odd;
    if (!r.usable || r.reason_code != LENSPROF_REASON_NONE) return;
    if (r.inlier_share < kSmallestShare || r.heldout_rms > kLargestRms)
        warn(r, {LENSPROF_REASON_MANY_OUTLIERS, {1.0 - r.inlier_share, r.heldout_rms}});
    else if (!r.evens)
        warn(r, {LENSPROF_REASON_SEAMS_STAY, {odd.value_or(overall).after, odd.value_or(overall).before}});
}

}  // namespace lensprof
