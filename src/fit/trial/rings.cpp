#include "fit/trial/rings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <Eigen/Cholesky>

#include "fit/base/constants.hpp"
#include "fit/trial/evaluator.hpp"
#include "fit/trial/robust.hpp"

namespace lensprof {
namespace {

constexpr double kSlope = 3.0;        // ln per r^2: prior standard deviation of the slope of d in the first ring
constexpr double kBend = 0.7;         // and of its change from one ring to the next
constexpr size_t kMinEnds = 20;       // of pairs, in a ring that is shown
constexpr size_t kMinPairs = 8;       // of a link
constexpr double kCell = 0.25;        // half diagonals: side of the areas within which errors are common
constexpr double kInflation = 1.3;    // of standard errors; and
constexpr double kFloor = 0.004;      // ln per r^2: error that none of them shows, on simulated scenes; and of fine
constexpr double kTexture = 0.003;    // texture, which differs in sharpness, per squared level of the residual
constexpr double kClear = 2.0;        // standard errors
constexpr double kSame = 0.03;        // EV: a difference that nobody sees
constexpr double kHidden = 0.1;       // EV: a standard error that does not show a difference
constexpr double kLeastKnown = 0.02;  // EV: least standard error of a known exposure, as in fits
constexpr int kAreaSide = 96;         // samples across the frame, for means over rings

// The weight of each node of d at r^2: nodes are the ends of rings.
RingVector node_weights(double r2) {
    RingVector weights = RingVector::Zero();
    double low = 0.0;
    for (int n = 0; n < kRings; n++) {
        const double high = kEnds[n] * kEnds[n];
        if (r2 <= high || n == kRings - 1) {
            const double share = std::min((r2 - low) / (high - low), 1.0);
            weights[n] = share;
            if (n > 0) weights[n - 1] = 1.0 - share;
            return weights;
        }
        low = high;
    }
    return weights;
}

int ring_of(double r2) {
    int ring = 0;
    while (ring < kRings - 1 && r2 > kEnds[ring] * kEnds[ring]) ring++;
    return ring;
}

double r2_of(const lensprof_fit_image &image, double x, double y) {
    const double dx = x - 0.5 * (image.width - 1.0), dy = y - 0.5 * (image.height - 1.0);
    const double rho = lensprof_half_diagonal(image.width, image.height);
    return (dx * dx + dy * dy) / (rho * rho);
}

// One channel of a pair.
struct Difference {
    size_t offset;       // of its link and channel
    size_t cell, link;   // clusters of common errors
    double y, sigma;     // ln of the ratio without the falloff; its error by one level of noise in both
    double log_falloff;  // ln M1/M2
    double mean_light;   // mean ln of irradiance
    uint32_t channel;
    RingVector nodes;  // weights at the first end less those at the second
};

class RingFit {
public:
    RingFit(const TrialPairs &pairs, const TrialModel &model, const ResponseError &response)
        : evaluator_(pairs, model),
          response_(response),
          unknowns_(kRings + static_cast<Eigen::Index>(response.shapes.size())) {
        std::map<std::pair<uint32_t, uint32_t>, size_t> count;
        for (const auto *half : {&pairs.train, &pairs.heldout})
            for (const lensprof_pair &pair : *half) count[std::minmax(pair.image[0], pair.image[1])]++;
        for (const auto *half : {&pairs.train, &pairs.heldout})
            for (const lensprof_pair &pair : *half)
                if (count[std::minmax(pair.image[0], pair.image[1])] >= kMinPairs) add(pairs, pair);
        offsets_.assign(offset_of_.size(), 0.0);
        solution_ = Eigen::VectorXd::Zero(unknowns_);
    }

    double scale() const { return scale_; }  // of the residuals, levels
    bool is_empty() const { return differences_.empty(); }
    const std::array<size_t, kRings> &ends() const { return ends_; }
    RingVector nodes() const { return solution_.head<kRings>(); }

    void solve() {
        const auto step_of = [&](const std::vector<double> &residuals, double scale, double end) {
            scale_ = scale;
            step(residuals, end);
            return residual_levels();
        };
        solve_robustly(differences_.size(), step_of);
    }

    // Of the nodes: by the scatter between areas or between links, per direction the larger one.
    RingMatrix covariance(const RingMatrix &means, RingVector &sigma) const {
        const Eigen::MatrixXd inverse = normal_.ldlt().solve(Eigen::MatrixXd::Identity(unknowns_, unknowns_));
        const Eigen::MatrixXd by_cell = sandwich(inverse, cell_of_.size(), [](const Difference &d) { return d.cell; });
        const Eigen::MatrixXd by_link = sandwich(inverse, link_of_.size(), [](const Difference &d) { return d.link; });
        const RingMatrix cells = means * by_cell.topLeftCorner<kRings, kRings>() * means.transpose();
        const RingMatrix links = means * by_link.topLeftCorner<kRings, kRings>() * means.transpose();
        for (int k = 0; k < kRings; k++) sigma[k] = std::sqrt(std::max(cells(k, k), links(k, k)));
        return cells;
    }

private:
    void add(const TrialPairs &pairs, const lensprof_pair &pair) {
        const int first = pair.image[0] < pair.image[1] ? 0 : 1, second = 1 - first;
        const std::pair<uint32_t, uint32_t> link{pair.image[first], pair.image[second]};
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
            differences_.push_back({index_of(offset_of_, std::make_pair(of_link, c)), of_cell, of_link,
                                    sign * d.log_ratio, d.sigma, falloff, mean, c, nodes});
            is_used = true;
        }
        for (int side = 0; side < 2 && is_used; side++) ends_[static_cast<size_t>(ring_of(r2[side]))]++;
    }

    template <class Key>
    static size_t index_of(std::map<Key, size_t> &indices, const Key &key) {
        return indices.try_emplace(key, indices.size()).first->second;
    }

    using Cell = std::tuple<uint32_t, uint32_t, int, int>;
    static Cell cell_at(const TrialPairs &pairs, const lensprof_pair &pair, int first) {
        const lensprof_fit_image &image = pairs.images[pair.image[first]];
        const double side = kCell * lensprof_half_diagonal(image.width, image.height);
        return {pair.image[first], pair.image[1 - first], static_cast<int>(pair.xy[first][0] / side),
                static_cast<int>(pair.xy[first][1] / side)};
    }

    // The error of ln g by a shape at irradiance `log_light`.
    double error_at(const LevelError &shape, const Difference &d, double log_light) const {
        const double level = lensprof_response_eval(&evaluator_.response(d.channel), std::exp(log_light), nullptr);
        const double position = level * (kErrorLevels - 1);
        const size_t i = std::min(static_cast<size_t>(position), kErrorLevels - 2);
        return shape[i] + (position - static_cast<double>(i)) * (shape[i + 1] - shape[i]);
    }

    // Derivatives of a difference by all unknowns. Those by errors of the response are at irradiances of which the
    // ratio is predicted: noise in it would appear as an error of the response.
    Eigen::VectorXd derivatives(const Difference &d) const {
        Eigen::VectorXd row(unknowns_);
        row.head<kRings>() = d.nodes;
        const double ratio = offsets_[d.offset] + d.log_falloff + d.nodes.dot(nodes());
        Eigen::Index n = kRings;
        for (const LevelError &shape : response_.shapes)
            row[n++] = error_at(shape, d, d.mean_light + 0.5 * ratio) - error_at(shape, d, d.mean_light - 0.5 * ratio);
        return row;
    }

    // Adds the prior: of slopes of d, and of errors of the response.
    void add_prior(Eigen::MatrixXd &normal) const {
        Eigen::VectorXd before = Eigen::VectorXd::Zero(unknowns_);
        double low = 0.0;
        for (int n = 0; n < kRings; n++) {
            const double width = kEnds[n] * kEnds[n] - low;
            Eigen::VectorXd slope = Eigen::VectorXd::Zero(unknowns_);
            slope[n] = 1.0 / width;
            if (n > 0) slope[n - 1] = -1.0 / width;
            const Eigen::VectorXd change = (slope - before) / (n == 0 ? kSlope : kBend);
            normal += change * change.transpose();
            before = slope, low = kEnds[n] * kEnds[n];
        }
        for (Eigen::Index n = kRings; n < unknowns_; n++) normal(n, n) += 1.0;
    }

    // One weighted least squares problem, from which the offsets are eliminated.
    void step(const std::vector<double> &residuals, double end) {
        const size_t count = differences_.size();
        rows_.resize(static_cast<Eigen::Index>(count), unknowns_);
        weights_.resize(count);
        std::vector<double> sum(offsets_.size()), mean(offsets_.size());
        Eigen::MatrixXd means = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(offsets_.size()), unknowns_);
        for (size_t i = 0; i < count; i++) {
            const Difference &d = differences_[i];
            weights_[i] = robust_weight(residuals[i], end) / std::pow(d.sigma * scale_, 2.0);
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
        add_prior(normal_);
        solution_ = normal_.ldlt().solve(right);
        for (size_t g = 0; g < offsets_.size(); g++)
            offsets_[g] = mean[g] - means.row(static_cast<Eigen::Index>(g)).dot(solution_);
        off_.resize(count);
        for (size_t i = 0; i < count; i++) {  // rows_ has the means taken out
            const Difference &d = differences_[i];
            off_[i] = d.y - mean[d.offset] - rows_.row(static_cast<Eigen::Index>(i)).dot(solution_);
        }
    }

    std::vector<double> residual_levels() const {
        std::vector<double> levels;
        for (size_t i = 0; i < differences_.size(); i++) levels.push_back(std::fabs(off_[i]) / differences_[i].sigma);
        return levels;
    }

    template <class ClusterOf>
    Eigen::MatrixXd sandwich(const Eigen::MatrixXd &inverse, size_t clusters, ClusterOf cluster_of) const {
        Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(unknowns_, static_cast<Eigen::Index>(clusters));
        for (size_t i = 0; i < differences_.size(); i++)
            scores.col(static_cast<Eigen::Index>(cluster_of(differences_[i]))) +=
                weights_[i] * off_[i] * rows_.row(static_cast<Eigen::Index>(i)).transpose();
        Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
        add_prior(prior);
        const double few = clusters > 1 ? clusters / (clusters - 1.0) : 1.0;
        return inverse * (few * scores * scores.transpose() + prior) * inverse;
    }

    const Evaluator evaluator_;
    const ResponseError &response_;
    const Eigen::Index unknowns_;
    std::vector<Difference> differences_;
    std::map<std::pair<uint32_t, uint32_t>, size_t> link_of_;
    std::map<std::pair<size_t, uint32_t>, size_t> offset_of_;
    std::map<Cell, size_t> cell_of_;
    std::array<size_t, kRings> ends_{};
    std::vector<double> offsets_, weights_, off_;
    Eigen::MatrixXd rows_, normal_;
    Eigen::VectorXd solution_;
    double scale_ = 1.0;
};

// Means over the rings of a frame: of the nodes' weights and of ln M.
struct RingMeans {
    RingMatrix nodes = RingMatrix::Zero();
    RingVector corrected = RingVector::Zero(), area = RingVector::Zero();
};

RingMeans means_over(const TrialPairs &pairs, const TrialModel &model) {
    RingMeans means;
    const lensprof_pair &pair = pairs.train.empty() ? pairs.heldout.front() : pairs.train.front();
    const lensprof_fit_image &image = pairs.images[pair.image[0]];
    for (int j = 0; j < kAreaSide; j++)
        for (int i = 0; i < kAreaSide; i++) {
            const double x = (i + 0.5) / kAreaSide * (image.width - 1.0),
                         y = (j + 0.5) / kAreaSide * (image.height - 1.0);
            const double r2 = r2_of(image, x, y);
            const int ring = ring_of(r2);
            means.area[ring]++;
            means.nodes.row(ring) += node_weights(r2).transpose();
            for (uint32_t c = 0; c < pairs.channels && model.falloff; c++)
                means.corrected[ring] +=
                    std::log(lensprof_profile_falloff(model.falloff, c, image.width, image.height, x, y, nullptr))
                    / pairs.channels;
        }
    for (int k = 0; k < kRings; k++) {
        if (!(means.area[k] > 0.0)) continue;
        means.nodes.row(k) /= means.area[k], means.corrected[k] /= means.area[k];
    }
    for (int k = kRings - 1; k >= 0; k--) {
        means.nodes.row(k) -= means.nodes.row(0).eval();
        means.corrected[k] -= means.corrected[0];
    }
    means.area /= kAreaSide * kAreaSide;
    return means;
}

// The falloff that the pictures show has the gamma of the response, M^gamma; the candidate's M has the true one.
void apply_gamma(const ResponseError &response, RingFalloff &found) {
    const double gamma = std::exp(response.log_gamma);
    found.remaining = (found.remaining + found.corrected) / gamma - found.corrected;
    const RingVector by_gamma = (found.remaining + found.corrected) * response.log_gamma_sigma;
    found.covariance = found.covariance / (gamma * gamma) + by_gamma * by_gamma.transpose();
}

}  // namespace

RingFalloff remaining_falloff(const TrialPairs &pairs, const TrialModel &model, const ResponseError &response) {
    RingFalloff found;
    RingFit fit(pairs, model, response);
    if (fit.is_empty()) return found;
    fit.solve();
    const RingMeans means = means_over(pairs, model);
    found.corrected = means.corrected, found.area = means.area;
    for (int k = 0; k < kRings; k++)
        if (fit.ends()[static_cast<size_t>(k)] >= kMinEnds && means.area[k] > 0.0)
            found.rings = static_cast<uint32_t>(k) + 1;
    found.remaining = means.nodes * fit.nodes();
    RingVector sigma = RingVector::Zero();
    found.covariance = fit.covariance(means.nodes, sigma);
    const double floor = kFloor + kTexture * fit.scale() * fit.scale();
    for (int k = 1; k < kRings; k++) {
        const double wanted = std::hypot(kInflation * sigma[k], floor * kEnds[k] * kEnds[k]),
                     given = std::sqrt(found.covariance(k, k));
        if (!(given > 0.0)) continue;
        found.covariance.row(k) *= wanted / given, found.covariance.col(k) *= wanted / given;
    }
    apply_gamma(response, found);
    return found;
}

void add_known_exposures(const std::vector<lensprof_fit_image> &images, const std::vector<double> &exposures,
                         ResponseError &response) {
    if (!(response.log_gamma_sigma > 0.0)) return;
    std::vector<std::array<double, 3>> known;  // weight, known exposure, that of the pictures
    std::array<double, 3> sum{};
    for (size_t i = 0; i < images.size(); i++) {
        if (!(images[i].known_ev_sigma > 0.0) || exposures[i] == 0.0) continue;
        const double sigma = kLn2 * std::max(images[i].known_ev_sigma, kLeastKnown);
        known.push_back({1.0 / (sigma * sigma), kLn2 * images[i].known_ev, exposures[i]});
        sum[0] += known.back()[0];
        for (size_t n = 1; n < 3; n++) sum[n] += known.back()[0] * known.back()[n];
    }
    double square = 0.0, product = 0.0;
    for (const auto &[weight, given, found] : known) {
        const double off = given - sum[1] / sum[0];
        square += weight * off * off, product += weight * off * (found - sum[2] / sum[0]);
    }
    if (!(square > 0.0) || !(product > 0.0)) return;
    const double by_known = std::log(product / square),
                 z = (by_known - response.log_gamma) / std::hypot(response.log_gamma_sigma, 1.0 / std::sqrt(square));
    const double prior = std::pow(response.log_gamma_sigma, -2.0) / (1.0 + z * z);  // its errors have heavy tails
    response.log_gamma = (prior * response.log_gamma + square * by_known) / (prior + square);
    response.log_gamma_sigma = 1.0 / std::sqrt(prior + square);
}

bool is_flatter(const RingFalloff &found) {
    double gain = 0.0;
    RingVector by_ring = RingVector::Zero();
    for (int k = 1; k < static_cast<int>(found.rings); k++) {
        const double m = found.corrected[k];
        gain += found.area[k] * m * (2.0 * found.remaining[k] + m);
        by_ring[k] = 2.0 * found.area[k] * m;
    }
    return gain > kClear * std::sqrt(by_ring.dot(found.covariance * by_ring)) && gain > std::pow(kSame * kLn2, 2.0);
}

void put_rings(const RingFalloff &found, lensprof_trial_candidate &candidate) {
    candidate.rings = found.rings;
    for (uint32_t k = 0; k < found.rings; k++) {
        candidate.ring_ev[k] = found.remaining[k] / kLn2;
        candidate.ring_sigma_ev[k] = std::sqrt(found.covariance(k, k)) / kLn2;
    }
    if (found.rings < 2) return;
    const double ev = candidate.ring_ev[found.rings - 1], sigma = candidate.ring_sigma_ev[found.rings - 1];
    if (std::fabs(ev) > std::max(kClear * sigma, kSame))
        candidate.corners = ev < 0.0 ? LENSPROF_TRIAL_CORNERS_TOO_DARK : LENSPROF_TRIAL_CORNERS_TOO_BRIGHT;
    else
        candidate.corners = sigma > kHidden ? LENSPROF_TRIAL_CORNERS_NOT_SHOWN : LENSPROF_TRIAL_CORNERS_AGREE;
}

}  // namespace lensprof
