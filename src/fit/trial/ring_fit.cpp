#include "fit/trial/ring_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "fit/trial/exposures.hpp"
#include "fit/trial/robust.hpp"

namespace lensprof {
namespace {

constexpr double kSlope = 3.0;        // ln per r^2: prior standard deviation of the slope of d in the first ring
constexpr double kFirstBend = 0.7;    // and of its change from one ring to the next, initially and at most; later it
constexpr double kUsualBend = 0.1;    // is measured, with one more change of this size
constexpr size_t kMinPairs = 8;       // of a link
constexpr double kCell = 0.25;        // half diagonals: side of the areas within which errors are common
constexpr size_t kLevelGroups = 8;    // of grey values within which they are
constexpr int kLightRounds = 3;       // of the search for the irradiance at both ends of a pair
constexpr double kLightStep = 0.5;    // ln, at most
constexpr double kLeastSlope = 1e-3;  // of a response by ln irradiance: flatter parts tell nothing

template <class Key>
size_t index_of(std::map<Key, size_t> &indices, const Key &key) {
    return indices.try_emplace(key, indices.size()).first->second;
}

std::tuple<uint32_t, uint32_t, int, int> cell_at(const TrialPairs &pairs, const lensprof_pair &pair, int first) {
    const lensprof_fit_image &image = pairs.images[pair.image[first]];
    const double side = kCell * lensprof_half_diagonal(image.width, image.height);
    return {pair.image[first], pair.image[1 - first], static_cast<int>(pair.xy[first][0] / side),
            static_cast<int>(pair.xy[first][1] / side)};
}

}  // namespace

RingFit::RingFit(const TrialPairs &pairs, const TrialModel &model, const ResponseError &response)
    : evaluator_(pairs, model),
      response_(response),
      pictures_(pairs.images.size()),
      green_(pairs.channels == 3 ? 1 : 0),
      unknowns_(kRings + static_cast<Eigen::Index>(response.shapes.size())),
      bend_(kFirstBend) {
    std::map<Link, size_t> count;
    for (const auto *half : {&pairs.train, &pairs.heldout})
        for (const lensprof_pair &pair : *half) count[std::minmax(pair.image[0], pair.image[1])]++;
    for (const auto *half : {&pairs.train, &pairs.heldout})
        for (const lensprof_pair &pair : *half)
            if (count[std::minmax(pair.image[0], pair.image[1])] >= kMinPairs) add(pairs, pair);
    offsets_.assign(offset_of_.size(), 0.0);
    solution_ = Eigen::VectorXd::Zero(unknowns_);
}

void RingFit::add(const TrialPairs &pairs, const lensprof_pair &pair) {
    const int first = pair.image[0] < pair.image[1] ? 0 : 1, second = 1 - first;
    const Link link{pair.image[first], pair.image[second]};
    double r2[2];
    for (int side = 0; side < 2; side++)
        r2[side] = r2_of(pairs.images[pair.image[side]], pair.xy[side][0], pair.xy[side][1]);
    const RingVector nodes = node_weights(r2[first]) - node_weights(r2[second]);
    const size_t of_link = index_of(link_of_, link), of_cell = index_of(cell_of_, cell_at(pairs, pair, first));
    bool is_used = false;
    for (uint32_t c = 0; c < pairs.channels; c++) {
        const IrradianceDifference d = evaluator_.difference(pair, c);
        if (!(d.sigma > 0.0)) continue;
        const double sign = first == 0 ? 1.0 : -1.0;
        double mean = 0.0;
        for (int side = 0; side < 2; side++)
            mean += 0.5 * std::log(lensprof_response_invert(&evaluator_.response(c), pair.value[side][c], nullptr));
        const double falloff = std::log(evaluator_.falloff(pair, first, c) / evaluator_.falloff(pair, second, c));
        differences_.push_back({index_of(offset_of_, std::make_pair(of_link, c)),
                                of_cell,
                                of_link,
                                {link.first, link.second},
                                c,
                                {pair.value[first][c], pair.value[second][c]},
                                falloff,
                                nodes,
                                mean,
                                sign * d.log_ratio,
                                d.sigma});
        is_used = true;
    }
    for (int side = 0; side < 2 && is_used; side++) ends_[static_cast<size_t>(ring_of(r2[side]))]++;
}

// The error of ln g by a shape at irradiance `log_light`.
double RingFit::error_at(const LevelError &shape, const Difference &d, double log_light) const {
    const double level = lensprof_response_eval(&evaluator_.response(d.channel), std::exp(log_light), nullptr);
    const double position = level * (kErrorLevels - 1);
    const size_t i = std::min(static_cast<size_t>(position), kErrorLevels - 2);
    return shape[i] + (position - static_cast<double>(i)) * (shape[i + 1] - shape[i]);
}

// ln of the ratio of irradiances at both ends, as found.
double RingFit::log_ratio(const Difference &d) const {
    return offsets_[d.offset] + d.log_falloff + d.nodes.dot(nodes());
}

// Orthogonal regression: the irradiance that is nearest to both grey values, of those whose ratio is the predicted
// one, and the difference from there, to first order. Logarithms of noisy grey values, and weights by them, would
// make the darker end too bright or too dark.
void RingFit::linearise(Difference &d) const {
    const double ratio = log_ratio(d);
    const lensprof_response &f = evaluator_.response(d.channel);
    double off[2], slope[2];
    for (int round = 0;; round++) {
        for (int side = 0; side < 2; side++) {
            const double light = std::exp(d.log_light + (side ? -0.5 : 0.5) * ratio);
            off[side] = d.value[side] - lensprof_response_eval(&f, light, &slope[side]);
            slope[side] *= light;
        }
        if (round == kLightRounds) break;
        const double square = slope[0] * slope[0] + slope[1] * slope[1];
        if (!(square > 0.0)) break;
        d.log_light += std::clamp((slope[0] * off[0] + slope[1] * off[1]) / square, -kLightStep, kLightStep);
    }
    if (!(slope[0] > kLeastSlope && slope[1] > kLeastSlope)) return;
    d.y = ratio - d.log_falloff + off[0] / slope[0] - off[1] / slope[1];
    d.sigma = std::sqrt(1.0 / (slope[0] * slope[0]) + 1.0 / (slope[1] * slope[1])) / 255.0;
}

// Derivatives of a difference by all unknowns. Those by errors of the response are at irradiances of which the
// ratio is predicted: noise in it would appear as an error of the response.
Eigen::VectorXd RingFit::derivatives(const Difference &d) const {
    Eigen::VectorXd row(unknowns_);
    row.head<kRings>() = d.nodes;
    const double ratio = log_ratio(d);
    Eigen::Index n = kRings;
    for (const LevelError &shape : response_.shapes)
        row[n++] = error_at(shape, d, d.log_light + 0.5 * ratio) - error_at(shape, d, d.log_light - 0.5 * ratio);
    return row;
}

// The slope of d by r^2 in the first ring, or its change from ring n - 1 to n, as a combination of the unknowns.
Eigen::VectorXd RingFit::bend_of(int n) const {
    Eigen::VectorXd bend = Eigen::VectorXd::Zero(unknowns_);
    for (int ring = std::max(0, n - 1); ring <= n; ring++) {
        const double low = ring > 0 ? kEnds[ring - 1] * kEnds[ring - 1] : 0.0;
        const double by_slope = (ring == n ? 1.0 : -1.0) / (kEnds[ring] * kEnds[ring] - low);
        bend[ring] += by_slope;
        if (ring > 0) bend[ring - 1] -= by_slope;
    }
    return bend;
}

// Of slopes of d, and of errors of the response: what it adds to the normal equations.
Eigen::MatrixXd RingFit::prior() const {
    Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
    for (int n = 0; n < kRings; n++) {
        const Eigen::VectorXd bend = bend_of(n) / (n == 0 ? kSlope : bend_);
        prior += bend * bend.transpose();
    }
    for (Eigen::Index n = kRings; n < unknowns_; n++) prior(n, n) += 1.0;
    return prior;
}

Eigen::MatrixXd RingFit::inverse() const {
    return normal_.ldlt().solve(Eigen::MatrixXd::Identity(unknowns_, unknowns_));
}

// One weighted least squares problem, from which the offsets are eliminated.
void RingFit::step(const std::vector<double> &residuals, double end) {
    const size_t count = differences_.size();
    rows_.resize(static_cast<Eigen::Index>(count), unknowns_);
    weights_.resize(count);
    std::vector<double> sum(offsets_.size()), mean(offsets_.size());
    Eigen::MatrixXd means = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(offsets_.size()), unknowns_);
    for (size_t i = 0; i < count; i++) {
        const Difference &d = differences_[i];
        weights_[i] = robust_weight(residuals[i], end) / (std::pow(d.sigma * scale_, 2.0) * common_);
        const auto row = static_cast<Eigen::Index>(i), group = static_cast<Eigen::Index>(d.offset);
        rows_.row(row) = derivatives(d);
        means.row(group) += weights_[i] * rows_.row(row);
        mean[d.offset] += weights_[i] * d.y, sum[d.offset] += weights_[i];
    }
    for (size_t g = 0; g < sum.size(); g++) means.row(static_cast<Eigen::Index>(g)) /= sum[g], mean[g] /= sum[g];
    normal_ = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns_);
    for (size_t i = 0; i < count; i++) {
        const auto row = static_cast<Eigen::Index>(i);
        rows_.row(row) -= means.row(static_cast<Eigen::Index>(differences_[i].offset));
        normal_.selfadjointView<Eigen::Lower>().rankUpdate(rows_.row(row).transpose(), weights_[i]);
        right += weights_[i] * (differences_[i].y - mean[differences_[i].offset]) * rows_.row(row).transpose();
    }
    normal_ = normal_.selfadjointView<Eigen::Lower>();
    normal_ += prior();
    solution_ = normal_.ldlt().solve(right);
    for (size_t g = 0; g < offsets_.size(); g++)
        offsets_[g] = mean[g] - means.row(static_cast<Eigen::Index>(g)).dot(solution_);
    off_.resize(count);
    for (size_t i = 0; i < count; i++) {  // rows_ has the means taken out
        const Difference &d = differences_[i];
        off_[i] = d.y - mean[d.offset] - rows_.row(static_cast<Eigen::Index>(i)).dot(solution_);
    }
}

std::vector<double> RingFit::residual_levels() const {
    std::vector<double> levels;
    for (size_t i = 0; i < differences_.size(); i++) levels.push_back(std::fabs(off_[i]) / differences_[i].sigma);
    return levels;
}

// Standard deviation of the bends of d, from those found (MacKay 1992, "Bayesian interpolation") and one more of
// kUsualBend.
void RingFit::update_bend() {
    const Eigen::MatrixXd covariance = inverse();
    double squares = kUsualBend * kUsualBend, determined = 1.0;
    for (int n = 1; n < kRings; n++) {
        const Eigen::VectorXd bend = bend_of(n);
        squares += std::pow(bend.dot(solution_), 2.0);
        determined += std::max(0.0, 1.0 - bend.dot(covariance * bend) / (bend_ * bend_));
    }
    bend_ = std::min(std::sqrt(squares / determined), kFirstBend);
}

void RingFit::solve_with_prior() {
    solve_robustly(differences_.size(), [&](const std::vector<double> &residuals, double scale, double end) {
        scale_ = scale;
        if (has_solution_) {
            for (Difference &d : differences_) linearise(d);
            update_bend();
        }
        step(residuals, end);
        has_solution_ = true;
        return residual_levels();
    });
}

// The prior has its weight compared with the number of independent pairs.
void RingFit::solve() {
    solve_with_prior();
    common_ = common_errors();
    solve_with_prior();
}

// The covariance that the scatter between groups of differences shows. groups_of(d, add) adds a difference to each of
// its groups.
template <class GroupsOf>
Eigen::MatrixXd RingFit::scatter(size_t count, GroupsOf groups_of) const {
    std::vector<OffsetMoments> all(offsets_.size(), OffsetMoments(unknowns_));
    std::vector<JackknifeGroup> groups(count);
    for (size_t i = 0; i < differences_.size(); i++) {
        const Difference &d = differences_[i];
        const Eigen::VectorXd row = rows_.row(static_cast<Eigen::Index>(i)).transpose();
        all[d.offset].add(weights_[i], row, off_[i]);
        groups_of(d, [&](size_t group) {
            groups[group].try_emplace(d.offset, unknowns_).first->second.add(weights_[i], row, off_[i]);
        });
    }
    return jackknife(normal_, all, groups);
}

Eigen::MatrixXd RingFit::scatter_of_cells() const {
    return scatter(cell_of_.size(), [](const Difference &d, auto add) { add(d.cell); });
}

// By how much the scatter between areas exceeds that of independent differences, over all that the data determine.
double RingFit::common_errors() const {
    const Eigen::MatrixXd of_data = normal_ - prior(), covariance = inverse();
    const double expected = (of_data * covariance * of_data * covariance).trace();
    const double ratio = expected > 0.0 ? (of_data * scatter_of_cells()).trace() / expected : 1.0;
    return std::max(1.0, ratio);
}

size_t RingFit::level_of(const Difference &d) const {
    const double level = lensprof_response_eval(&evaluator_.response(d.channel), std::exp(d.log_light), nullptr);
    return std::min(static_cast<size_t>(level * kLevelGroups), kLevelGroups - 1);
}

RingMatrix RingFit::covariance(const RingMatrix &functions) const {
    const auto of = [&](const Eigen::MatrixXd &all) -> RingMatrix {
        return functions * all.topLeftCorner<kRings, kRings>() * functions.transpose();
    };
    const Eigen::MatrixXd covariance = inverse();
    const RingMatrix cells = of(scatter_of_cells()), prior_error = of(covariance * prior() * covariance),
                     links = of(scatter(link_of_.size(), [](const Difference &d, auto add) { add(d.link); })),
                     levels = of(scatter(kLevelGroups, [&](const Difference &d, auto add) { add(level_of(d)); })),
                     pictures = of(scatter(pictures_, [](const Difference &d, auto add) {
                         for (const uint32_t image : d.image) add(image);
                     }));
    RingMatrix found = cells + prior_error;
    for (int k = 0; k < kRings; k++) {
        if (!(found(k, k) > 0.0)) continue;
        const double largest =
            std::max({cells(k, k), links(k, k), levels(k, k), pictures(k, k) - links(k, k)}) + prior_error(k, k);
        const double factor = std::sqrt(largest / found(k, k));
        found.row(k) *= factor, found.col(k) *= factor;
    }
    return found;
}

std::vector<double> RingFit::exposures() const {
    std::vector<IrradianceDifference> links;
    for (const auto &[link, number] : link_of_) {
        const auto offset = offset_of_.find({number, green_});
        if (offset != offset_of_.end()) links.push_back({{link.first, link.second}, offsets_[offset->second], 1.0});
    }
    return log_exposures(links, static_cast<uint32_t>(pictures_));
}

}  // namespace lensprof
