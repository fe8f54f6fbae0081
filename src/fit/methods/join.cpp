#include "fit/methods/join.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "falloff/dense.hpp"
#include "fit/base/constants.hpp"
#include "fit/base/parallel.hpp"
#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

constexpr double kSmallestScatter = 0.01;  // of light, natural logarithm: misplaced texture
constexpr double kCutoff = 3.0;            // standard deviations beyond which a pair loses its weight
constexpr double kKnownSigma = 1e-6;       // of ln gamma if known
constexpr double kLargestLogGamma = 1.2;   // in total
constexpr int kJoinRounds = 40;
constexpr double kConverged = 1e-7;

// A weighted residual, and its derivatives by gamma and offset of both cameras.
struct Slopes {
    double residual;
    int column[4];
    double slope[4];
};

// The estimated values: ln gamma of every camera, then its offsets, one per channel.
class Join {
public:
    Join(std::vector<LightPair> pairs, const std::vector<double> &gamma_sigma, uint32_t reference, int channels,
         const std::function<bool()> &cancelled)
        : pairs_(std::move(pairs)),
          cancelled_(cancelled),
          sigma_(gamma_sigma),
          count_(static_cast<int>(gamma_sigma.size())),
          reference_(reference),
          channels_(channels),
          joints_(gamma_sigma.size()) {}

    std::vector<Joint> run() {
        std::vector<bool> may_join(joints_.size(), true);
        for (;;) {
            take_reached(may_join);
            solve();
            describe();
            const size_t worst = farthest();
            if (joints_[worst].residual <= kLargestLightDifference) return joints_;
            may_join[worst] = false;
        }
    }

private:
    int gamma_column(uint32_t camera) const { return static_cast<int>(camera); }
    int offset_column(uint32_t camera, int channel) const {
        return count_ + channels_ * static_cast<int>(camera) + channel;
    }
    bool takes(const LightPair &pair) const { return joints_[pair.camera[0]].joined && joints_[pair.camera[1]].joined; }

    void take_reached(const std::vector<bool> &may_join);
    size_t farthest() const;
    void start_offsets();
    double residual(const LightPair &pair, int channel) const;
    double variance(const LightPair &pair, int channel) const;
    double chi2(const LightPair &pair) const;
    double weight(const LightPair &pair) const {
        const double z = chi2(pair) / (kCutoff * kCutoff);
        return 1.0 / (1.0 + z * z);
    }
    Slopes slopes(const LightPair &pair, int channel) const;
    void find_scatter();
    double step(Eigen::MatrixXd &normal);
    void solve();
    Eigen::MatrixXd covariance_by_links() const;
    void count_pairs();
    void describe();

    const std::vector<LightPair> pairs_;
    const std::function<bool()> &cancelled_;
    const std::vector<double> &sigma_;
    const int count_;
    const uint32_t reference_;
    const int channels_;
    std::vector<Joint> joints_;
    Eigen::VectorXd estimate_;  // ln gamma of every camera, then its offsets
    double scatter_ = 0.0;      // of light, beyond the noise of grey values, natural logarithm
    Eigen::MatrixXd cov_;
};

// Selects the cameras that enough pairs join to the reference's, directly or through others.
void Join::take_reached(const std::vector<bool> &may_join) {
    std::map<std::array<uint32_t, 2>, size_t> between;
    for (const LightPair &pair : pairs_)
        between[{std::min(pair.camera[0], pair.camera[1]), std::max(pair.camera[0], pair.camera[1])}]++;
    for (Joint &joint : joints_) joint = {};
    joints_[reference_].joined = true;
    for (bool any = true; any;) {
        any = false;
        for (const auto &[ends, pairs] : between) {
            Joint &a = joints_[ends[0]], &b = joints_[ends[1]];
            if (pairs < kMinJoiningPairs || a.joined == b.joined || !may_join[ends[0]] || !may_join[ends[1]]) continue;
            a.joined = b.joined = any = true;
        }
    }
}

// The camera, other than the reference's, whose light differs most from that of the others; the reference's if it is
// alone.
size_t Join::farthest() const {
    size_t worst = reference_;
    for (size_t k = 0; k < joints_.size(); k++)
        if (k != reference_ && joints_[k].joined
            && (worst == reference_ || joints_[k].residual > joints_[worst].residual))
            worst = k;
    return worst;
}

double Join::residual(const LightPair &pair, int c) const {
    double value[2];
    for (int side = 0; side < 2; side++)
        value[side] = std::exp(estimate_[gamma_column(pair.camera[side])]) * pair.log_light[side][c]
                      + estimate_[offset_column(pair.camera[side], c)];
    return value[0] - value[1];
}

double Join::variance(const LightPair &pair, int c) const {
    double sum = 0.0;
    for (int side = 0; side < 2; side++)
        sum += std::exp(2.0 * estimate_[gamma_column(pair.camera[side])])
               * (pair.variance[side][c] + 0.5 * scatter_ * scatter_);
    return sum;
}

double Join::chi2(const LightPair &pair) const {
    double sum = 0.0;
    for (int c = 0; c < channels_; c++) sum += std::pow(residual(pair, c), 2) / variance(pair, c);
    return sum / channels_;
}

// r / s; gamma also affects the standard deviation s.
Slopes Join::slopes(const LightPair &pair, int c) const {
    const double r = residual(pair, c), v = variance(pair, c), s = std::sqrt(v);
    Slopes result{r / s, {}, {}};
    for (int side = 0; side < 2; side++) {
        const uint32_t camera = pair.camera[side];
        const double gamma = std::exp(estimate_[gamma_column(camera)]), sign = side ? -1.0 : 1.0;
        const double variance_slope = gamma * gamma * (pair.variance[side][c] + 0.5 * scatter_ * scatter_);
        result.column[2 * side] = gamma_column(camera);
        result.slope[2 * side] = sign * gamma * pair.log_light[side][c] / s - r * variance_slope / (v * s);
        result.column[2 * side + 1] = offset_column(camera, c);
        result.slope[2 * side + 1] = sign / s;
    }
    return result;
}

// Start values from medians, from camera to camera.
void Join::start_offsets() {
    estimate_ = Eigen::VectorXd::Zero(count_ * (1 + channels_));
    std::vector<bool> is_known(joints_.size());
    is_known[reference_] = true;
    for (bool any = true; any;) {
        any = false;
        std::map<std::pair<uint32_t, int>, std::vector<double>> differences;  // for a new camera and channel
        for (const LightPair &pair : pairs_) {
            if (!takes(pair) || is_known[pair.camera[0]] == is_known[pair.camera[1]]) continue;
            const uint32_t camera = pair.camera[is_known[pair.camera[0]]];
            for (int c = 0; c < channels_; c++)
                differences[{camera, c}].push_back(is_known[pair.camera[0]] ? residual(pair, c) : -residual(pair, c));
        }
        for (auto &[of, values] : differences) {
            estimate_[offset_column(of.first, of.second)] = median(values);
            is_known[of.first] = any = true;
        }
    }
}

// Robustly estimates the scatter of the residuals beyond the noise of grey values.
void Join::find_scatter() {
    std::vector<double> squares;
    for (const LightPair &pair : pairs_)
        for (int c = 0; c < channels_ && takes(pair); c++) {
            const double scale =
                std::exp(estimate_[gamma_column(pair.camera[0])] + estimate_[gamma_column(pair.camera[1])]);
            const double noise = pair.variance[0][c] + pair.variance[1][c];
            squares.push_back(std::max(0.0, std::pow(kMadToSigma * residual(pair, c), 2) / scale - noise));
        }
    scatter_ = std::max(kSmallestScatter, std::sqrt(median(squares)));
}

// One Gauss-Newton step of the weighted residuals; returns its length. `normal` receives the normal equations.
double Join::step(Eigen::MatrixXd &normal) {
    const auto size = estimate_.size();
    normal = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (const LightPair &pair : pairs_) {
        if (!takes(pair)) continue;
        const double trust = weight(pair);
        for (int c = 0; c < channels_; c++) {
            const Slopes row = slopes(pair, c);
            for (int i = 0; i < 4; i++) {
                right[row.column[i]] -= trust * row.slope[i] * row.residual;
                for (int j = 0; j < 4; j++) normal(row.column[i], row.column[j]) += trust * row.slope[i] * row.slope[j];
            }
        }
    }
    for (uint32_t k = 0; k < joints_.size(); k++) {
        const int g = gamma_column(k);
        const double precision = 1.0 / std::pow(std::max(sigma_[k], kKnownSigma), 2);
        normal(g, g) += precision, right[g] -= precision * estimate_[g];
        for (int c = 0; c < channels_; c++) {  // of the reference 0; cameras that are not joined are undetermined
            const int b = offset_column(k, c);
            if (k != reference_ && joints_[k].joined) continue;
            normal.row(b).setZero(), normal.col(b).setZero();
            normal(b, b) = 1.0, right[b] = 0.0;
        }
    }
    const Eigen::VectorXd change = solve_symmetric(normal, right);
    const double length = change.cwiseAbs().maxCoeff();
    if (!std::isfinite(length)) return 0.0;
    estimate_ += change;
    for (int k = 0; k < count_; k++) estimate_[k] = std::clamp(estimate_[k], -kLargestLogGamma, kLargestLogGamma);
    return length;
}

void Join::solve() {
    start_offsets();
    Eigen::MatrixXd normal;
    for (int round = 0; round < kJoinRounds; round++) {
        if (cancelled_()) throw Cancelled();
        find_scatter();
        if (step(normal) < kConverged) break;
    }
    cov_ = inverse_of_symmetric(normal);
}

// The covariance of the estimate if not pairs but links of images, each as a whole, are independent.
Eigen::MatrixXd Join::covariance_by_links() const {
    std::map<std::array<uint32_t, 2>, Eigen::VectorXd> gradients;  // for each link's part of the objective
    for (const LightPair &pair : pairs_) {
        if (!takes(pair)) continue;
        const double trust = weight(pair);
        auto &gradient = gradients.try_emplace({pair.image[0], pair.image[1]}, Eigen::VectorXd::Zero(estimate_.size()))
                             .first->second;
        for (int c = 0; c < channels_; c++) {
            const Slopes row = slopes(pair, c);
            for (int i = 0; i < 4; i++) gradient[row.column[i]] += trust * row.slope[i] * row.residual;
        }
    }
    Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(estimate_.size(), estimate_.size());
    for (const auto &[link, gradient] : gradients) squares += gradient * gradient.transpose();
    return cov_ * squares * cov_;
}

// Counts the pairs that join each camera, and how well they agree.
void Join::count_pairs() {
    std::vector<std::vector<double>> residuals(joints_.size());
    std::vector<size_t> inliers(joints_.size());
    for (const LightPair &pair : pairs_) {
        if (!takes(pair)) continue;
        for (const uint32_t camera : pair.camera) {
            for (int c = 0; c < channels_; c++) residuals[camera].push_back(std::abs(residual(pair, c)));
            inliers[camera] += chi2(pair) < kCutoff * kCutoff;
            joints_[camera].pairs++;
        }
    }
    for (size_t k = 0; k < joints_.size(); k++) {
        joints_[k].inlier_share = joints_[k].pairs ? static_cast<double>(inliers[k]) / joints_[k].pairs : 1.0;
        joints_[k].residual = median(residuals[k]);
    }
}

// Writes the estimate and its standard errors, the larger of those by pairs and by links.
void Join::describe() {
    count_pairs();
    const Eigen::MatrixXd by_links = covariance_by_links();
    const auto larger = [&](const auto &variance_by) {
        return std::sqrt(std::max({0.0, variance_by(cov_), variance_by(by_links)}));
    };
    const auto sigma_of = [&](int column) {
        return larger([&](const Eigen::MatrixXd &m) { return m(column, column); });
    };
    const auto sigma_between = [&](int first, int second) {
        return larger(
            [&](const Eigen::MatrixXd &m) { return m(first, first) + m(second, second) - 2.0 * m(first, second); });
    };
    const int measured = channels_ == 3 ? 1 : 0;
    for (uint32_t k = 0; k < joints_.size(); k++) {
        Joint &joint = joints_[k];
        if (!joint.joined) continue;
        const bool is_open = sigma_[k] > 0.0;
        joint.log_gamma = is_open ? estimate_[gamma_column(k)] : 0.0;
        joint.log_gamma_sigma = is_open ? sigma_of(gamma_column(k)) : 0.0;
        for (int c = 0; c < channels_; c++) joint.offset[static_cast<size_t>(c)] = estimate_[offset_column(k, c)];
        if (k == reference_) continue;
        joint.offset_sigma = sigma_of(offset_column(k, measured));
        for (int c = 0; c < channels_; c++)
            joint.balance_sigma[static_cast<size_t>(c)] =
                sigma_between(offset_column(k, c), offset_column(k, measured));
    }
}

// Light of a pair's first channel in the camera with the smaller number, or in the other.
double light_in(const LightPair &pair, bool is_other) {
    return pair.log_light[(pair.camera[0] > pair.camera[1]) != is_other][0];
}

// Centre and spread of such light.
struct Spread {
    double middle, spread;
};
Spread spread_of(const std::vector<const LightPair *> &pairs, bool is_other) {
    std::vector<double> values;
    for (const LightPair *pair : pairs) values.push_back(light_in(*pair, is_other));
    Spread found{median(values), 0.0};
    for (double &value : values) value = std::abs(value - found.middle);
    found.spread = median(values);
    return found;
}

// Whether light that two cameras saw may be the same: a rough test, with the ratio of its spreads as the exponent.
bool may_agree(const std::vector<const LightPair *> &pairs) {
    const Spread a = spread_of(pairs, false), b = spread_of(pairs, true);
    const double exponent = a.spread > 0.0 && b.spread > 0.0 ? std::sqrt(a.spread / b.spread) : 1.0;
    std::vector<double> differences;
    for (const LightPair *pair : pairs)
        differences.push_back(
            std::abs((light_in(*pair, false) - a.middle) / exponent - (light_in(*pair, true) - b.middle) * exponent));
    return median(differences) < 2.0 * kLargestLightDifference;
}

// Drops the pairs of two cameras whose light has nothing in common; otherwise the joint solution would have to find
// them one by one.
std::vector<LightPair> agreeing(const std::vector<LightPair> &pairs) {
    std::map<std::array<uint32_t, 2>, std::vector<const LightPair *>> between;
    for (const LightPair &pair : pairs)
        between[{std::min(pair.camera[0], pair.camera[1]), std::max(pair.camera[0], pair.camera[1])}].push_back(&pair);
    std::vector<LightPair> kept;
    for (const auto &[cameras, joining] : between)
        if (joining.size() >= kMinJoiningPairs && may_agree(joining))
            for (const LightPair *pair : joining) kept.push_back(*pair);
    return kept;
}

}  // namespace

std::vector<Joint> join_cameras(const std::vector<LightPair> &pairs, const std::vector<double> &gamma_sigma,
                                uint32_t reference, int channels, const std::function<bool()> &cancelled) {
    return Join(agreeing(pairs), gamma_sigma, reference, channels, cancelled).run();
}

}  // namespace lensprof
