// Information from known exposures about gamma and the fitted exposures.
#include <algorithm>
#include <cmath>
#include <set>

#include "fit/base/constants.hpp"
#include "fit/prior/gauge.hpp"
#include "fit/prior/known_levels.hpp"

namespace lensprof {
namespace {

constexpr double kSmallestSlope = 0.1;    // and its inverse: beyond, known exposures belong to something else
constexpr double kContradiction = 5.0;    // standard errors from the level of most images
constexpr size_t kFew = 4;                // one in four at most is wrong: with more it is unclear which are
constexpr size_t kMinKnownForLevels = 6;  // known exposures: with fewer, it is unclear which one is wrong

// Known exposures are repeatable to less than kRepeatable, EV. The pairs between two pictures share errors that no
// model describes (falloff that is not radial, bias by noise). With more than kLinkPairs pairs these errors add up
// along a row of pictures like a drift, and the hold scales accordingly.
constexpr double kRepeatable = 0.05, kLinkPairs = 40.0;

bool is_known(const Problem &problem, uint32_t i) {
    return problem.images[i].known_ev_sigma > 0.0 && problem.component[i] == problem.component[problem.reference];
}

// The known exposures of the reference's group and what was found, EV, by image.
struct KnownGroup {
    std::vector<uint32_t> members;
    std::vector<bool> is_member;
    std::vector<double> found, known, sigma;

    KnownGroup(const Problem &problem, const Estimate &estimate)
        : is_member(problem.image_count),
          found(problem.image_count),
          known(problem.image_count),
          sigma(problem.image_count) {
        for (uint32_t i = 0; i < problem.image_count; i++) {
            const auto &image = problem.images[i];
            if (!is_known(problem, i)) continue;
            members.push_back(i);
            is_member[i] = true;
            found[i] = estimate.log_exposure[i][static_cast<size_t>(problem.measured_channel())] / kLn2;
            known[i] = image.known_ev, sigma[i] = known_sigma(image);
        }
    }
};

// One level: number of its images, weights and means.
struct Level {
    size_t count = 0;
    double weight = 0.0, trust = 0.0, found = 0.0, known = 0.0;
};

// Sums of squares about the means of the levels, in standard errors.
struct Regression {
    std::vector<Level> levels;
    size_t largest = 0;
    double trust = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;  // trust: yy if all exposures are equal

    Regression(const KnownGroup &known, const std::vector<int> &level, const std::vector<double> &trusts,
               double scatter)
        : levels(1 + static_cast<size_t>(*std::max_element(level.begin(), level.end()))) {
        auto weight = [&](uint32_t i) { return trusts[i] / std::pow(scatter * known.sigma[i], 2); };
        for (uint32_t i : known.members) {
            Level &group = levels[static_cast<size_t>(level[i])];
            group.count++, group.weight += weight(i), group.trust += trusts[i];
            group.found += weight(i) * known.found[i], group.known += weight(i) * known.known[i];
        }
        for (size_t l = 0; l < levels.size(); l++) {
            levels[l].found /= levels[l].weight, levels[l].known /= levels[l].weight;
            if (levels[l].count > 1) trust += levels[l].trust;
            if (levels[l].count > levels[largest].count) largest = l;
        }
        for (uint32_t i : known.members) {
            const Level &group = levels[static_cast<size_t>(level[i])];
            const double dx = known.found[i] - group.found, dy = known.known[i] - group.known;
            xx += weight(i) * dx * dx, xy += weight(i) * dx * dy, yy += weight(i) * dy * dy;
        }
    }

    // Distance of an image from a level, EV.
    double off(const KnownGroup &known, uint32_t i, size_t level, double per_known) const {
        return per_known * (known.found[i] - levels[level].found) - (known.known[i] - levels[level].known);
    }
};

}  // namespace

// Regression of the known exposures on the estimate's, over the reference's component; the known ones carry the error.
// Their variation beyond their own error determines gamma; equal exposures do not. If they scatter more than stated,
// the scatter is used as their error. It is measured from neighbour to neighbour, because errors that add up along a
// row of pictures belong to the estimate. Known exposures that agree are on one level (known_levels.hpp), which
// has its own offset. An image alone on its level is left out; the others are known as accurately as before.
void Gauge::compare_known(const Problem &problem, const Estimate &estimate) {
    slope_ = 1.0, slope_sigma_ = 0.0, known_offset_ = 0.0, scatter_ = 1.0;
    known_left_out_.clear();
    if (known_weight_.empty()) return;
    const KnownGroup known(problem, estimate);
    if (known.members.size() < 2) known_weight_.clear();  // only differences carry information
    if (known_weight_.empty()) return;
    const KnownNeighbours neighbours(problem, known.is_member);
    const size_t count = problem.image_count;
    std::vector<int> level(count, 0);
    std::vector<double> off(count);
    known_weight_.assign(count, 1.0);
    level_offset_.assign(count, 0.0);
    for (int round = 0; round < 8; round++) {
        if (round > 0 && known.members.size() >= kMinKnownForLevels)
            level = neighbours.levels(off, known.sigma, scatter_);
        const Regression regression(known, level, known_weight_, scatter_);
        const double excess = regression.yy > 0.0 ? std::max(0.0, 1.0 - regression.trust / regression.yy) : 0.0;
        const bool is_informative = open_ && excess > 0.0 && regression.xy > kSmallestSlope * regression.xx
                                    && regression.xy * kSmallestSlope < regression.xx;
        const double per_known = is_informative ? regression.xy / regression.xx : 1.0;  // known EV per found EV
        slope_ = 1.0 / per_known;
        slope_sigma_ = is_informative ? 1.0 / (per_known * std::sqrt(regression.xx * excess)) : 0.0;
        auto offset = [&](size_t l) {
            return kLn2 * (regression.levels[l].found - slope_ * regression.levels[l].known);
        };
        known_offset_ = offset(regression.largest);
        std::vector<double> distances;
        for (uint32_t i : known.members) {
            off[i] = regression.off(known, i, regression.largest, per_known);
            distances.push_back(std::abs(off[i]) / known.sigma[i]);
        }
        scatter_ = std::min(scatter_of(distances, 2), neighbours.scatter(off, known.sigma));
        for (uint32_t i : known.members) {
            const auto own_level = static_cast<size_t>(level[i]);
            const double z = regression.off(known, i, own_level, per_known) / (kDoubtful * scatter_ * known.sigma[i]);
            known_weight_[i] = 1.0 / (1.0 + z * z);
            level_offset_[i] = offset(own_level);
        }
    }
    leave_out(problem, off);
}

// Leaves out the few that are far from the level of most images.
void Gauge::leave_out(const Problem &problem, const std::vector<double> &off) {
    size_t count = 0;
    for (uint32_t i = 0; i < problem.image_count; i++) {
        if (!is_known(problem, i)) continue;
        count++;
        const double limit = kContradiction * scatter_ * known_sigma(problem.images[i]);
        if (std::abs(off[i]) > limit) known_left_out_.insert(i);
    }
    if (count < kMinKnownForLevels || known_left_out_.size() * kFew > count) known_left_out_.clear();
}

void Gauge::put_known(const Problem &problem, Prior &prior) const {
    prior.known.clear();
    prior.renews_offset = false;
    if (known_weight_.empty()) return;
    prior.known.resize(problem.image_count);
    const double pairs =
        static_cast<double>(problem.pairs.size()) / static_cast<double>(std::max<size_t>(problem.edges.size(), 1));
    for (uint32_t i = 0; i < problem.image_count; i++) {
        const auto &image = problem.images[i];
        if (!is_known(problem, i)) continue;
        auto &known = prior.known[i];
        known.log_exposure = level_offset_[i] + slope_ * kLn2 * image.known_ev;
        known.precision = known_weight_[i] / std::pow(slope_ * kLn2 * scatter_ * known_sigma(image), 2);
        if (scatter_ * known_sigma(image) < kRepeatable) known.hold = std::max(1.0, pairs / kLinkPairs);
        known.precision *= known.hold;
        prior.renews_offset = prior.renews_offset || known.hold > 1.0;
    }
}

// All equal to the reference's.
void Gauge::put_equal(const Problem &problem, const Estimate &estimate, Prior &prior) const {
    constexpr double kFirm = 1e-3, kSigma = 0.05;  // EV; kSigma: for differences that the test of equality misses
    const double expected = estimate.log_exposure[problem.reference][static_cast<size_t>(problem.measured_channel())];
    std::set<int> done;  // images can share an unknown
    prior.known.resize(problem.image_count);
    for (uint32_t i = 0; i < problem.image_count; i++)
        if (problem.component[i] == problem.component[problem.reference] && done.insert(problem.ev_unknown[i]).second)
            prior.known[i] = {expected, 1.0 / std::pow(kLn2 * kFirm, 2), std::pow(kSigma / kFirm, 2)};
}

}  // namespace lensprof
