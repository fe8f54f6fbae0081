#include "fit/trial/residuals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "fit/base/constants.hpp"
#include "fit/base/joined_sets.hpp"
#include "fit/base/mixed_bits.hpp"
#include "fit/base/quantile.hpp"
#include "fit/trial/evaluator.hpp"
#include "fit/trial/exposures.hpp"

namespace lensprof {
namespace {

constexpr double kExplainedSigmas = 5.0;  // a pair that no model explains better shows two different objects
constexpr double kMinExplained = 3.0;     // levels
constexpr size_t kMinLinks = 5;           // with meaningful scatter

// A hash of a pair's index, independent of the order along images.
uint64_t pair_hash(uint64_t pair) { return mixed_bits((pair + 1) * splitmix_step); }

void add_pair(const std::vector<double> &levels, TrialErrors &errors) {
    double sum = 0.0;
    for (double level : levels) sum += level * level, errors.absolutes.push_back(std::fabs(level));
    errors.squares.push_back(sum / static_cast<double>(levels.size()));
}

}  // namespace

TrialPairs split_pairs(std::vector<lensprof_fit_image> images, const std::vector<lensprof_pair> &pairs,
                       uint32_t channels) {
    TrialPairs split;
    split.channels = channels;
    JoinedSets groups(images.size());
    for (size_t p = 0; p < pairs.size(); p++) {
        const bool is_train = pair_hash(p) % 2 == 0;
        (is_train ? split.train : split.heldout).push_back(pairs[p]);
        if (is_train) groups.join(pairs[p].image[0], pairs[p].image[1]);
    }
    const auto is_unconnected = [&](const lensprof_pair &pair) {
        return groups.of(pair.image[0]) != groups.of(pair.image[1]);
    };
    split.heldout.erase(std::remove_if(split.heldout.begin(), split.heldout.end(), is_unconnected),
                        split.heldout.end());
    split.images = std::move(images);
    return split;
}

TrialErrors try_model(const TrialPairs &pairs, const TrialModel &model) {
    const Evaluator evaluator(pairs, model);
    std::array<std::vector<double>, 3> exposures;
    for (uint32_t c = 0; c < pairs.channels; c++) {
        std::vector<IrradianceDifference> differences;
        for (const lensprof_pair &pair : pairs.train) differences.push_back(evaluator.difference(pair, c));
        exposures[c] = log_exposures(differences, static_cast<uint32_t>(pairs.images.size()));
    }
    TrialErrors errors;
    for (const lensprof_pair &pair : pairs.heldout) {
        std::vector<double> levels;
        for (uint32_t c = 0; c < pairs.channels; c++)
            for (double level : evaluator.residuals(pair, c, exposures[c][pair.image[0]] - exposures[c][pair.image[1]]))
                levels.push_back(level);
        add_pair(levels, errors);
    }
    return errors;
}

TrialErrors uncorrected_errors(const TrialPairs &pairs) {
    TrialErrors errors;
    for (const lensprof_pair &pair : pairs.heldout) {
        std::vector<double> levels;
        for (uint32_t c = 0; c < pairs.channels; c++) levels.push_back(255.0 * (pair.value[0][c] - pair.value[1][c]));
        add_pair(levels, errors);
    }
    return errors;
}

std::vector<bool> explained_pairs(const std::vector<const TrialErrors *> &candidates) {
    const size_t pairs = candidates.front()->squares.size();
    if (!pairs) return {};
    double min_median = HUGE_VAL;
    for (const TrialErrors *errors : candidates)
        min_median = std::min(min_median, std::sqrt(upper_median(errors->squares)));
    const double limit = std::max(kMinExplained, kExplainedSigmas * kMadToSigma * min_median);
    std::vector<bool> is_explained(pairs);
    for (size_t p = 0; p < pairs; p++)
        is_explained[p] = std::any_of(candidates.begin(), candidates.end(),
                                      [&](const TrialErrors *errors) { return errors->squares[p] <= limit * limit; });
    return is_explained;
}

TrialFigures figures_of(const TrialErrors &errors, const std::vector<bool> &is_explained) {
    std::vector<double> absolutes;
    double sum = 0.0, count = 0.0;
    const size_t values_per_pair = errors.absolutes.size() / errors.squares.size();
    for (size_t p = 0; p < is_explained.size(); p++) {
        if (!is_explained[p]) continue;
        sum += errors.squares[p], count++;
        for (size_t n = 0; n < values_per_pair; n++) absolutes.push_back(errors.absolutes[p * values_per_pair + n]);
    }
    return {std::sqrt(sum / count), upper_median(absolutes)};
}

TrialDifference difference_of(const TrialErrors &a, const TrialErrors &b, const TrialPairs &pairs,
                              const std::vector<bool> &is_explained) {
    double sum = 0.0, n = 0.0;
    for (size_t p = 0; p < is_explained.size(); p++)
        if (is_explained[p]) sum += a.squares[p] - b.squares[p], n++;
    const double mean = sum / n;
    double scatter = 0.0, link_scatter = 0.0;
    std::map<std::pair<uint32_t, uint32_t>, double> links;
    for (size_t p = 0; p < is_explained.size(); p++) {
        if (!is_explained[p]) continue;
        const double off = a.squares[p] - b.squares[p] - mean;
        scatter += off * off;
        links[std::minmax(pairs.heldout[p].image[0], pairs.heldout[p].image[1])] += off;
    }
    for (const auto &link : links) link_scatter += link.second * link.second;
    const double variance = links.size() < kMinLinks ? scatter : std::max(scatter, link_scatter);
    const double rms = figures_of(a, is_explained).rms + figures_of(b, is_explained).rms;
    if (!(rms > 0.0)) return {};
    return {mean / rms, std::sqrt(variance) / n / rms};
}

}  // namespace lensprof
