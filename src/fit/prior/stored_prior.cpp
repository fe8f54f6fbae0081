#include "fit/prior/stored_prior.hpp"

#include <algorithm>
#include <cmath>

#include "core/covariance.h"
#include "core/profile.h"
#include "core/response.h"
#include "falloff/dense.hpp"
#include "fit/prior/gauge.hpp"
#include "fit/problem/curve_shape.hpp"

namespace lensprof {
namespace {

// Two sequences of one lens differ by more than noise (focus, stray light, registration). This share of the scatter
// over all cameras and lenses is added to a profile's own covariance, so that no number of sequences makes it certain.
constexpr double kDrift = 0.01;

// A refined response stores no covariance except the error of its gamma. Assumed for its shape: the residual of refined
// brackets, levels RMS, and the share of the scatter over all cameras by which a camera's curve differs from day to
// day.
constexpr int kCurveModes = 9;
constexpr double kCurveLevels = 0.2, kCurveDrift = 0.025;

constexpr double kRadii2[4] = {0.1, 0.25, 0.5, 1.0};  // r^2 at which falloffs are compared
constexpr double kUninformative = 0.7;  // a standard error of ln gamma from here on carries no information

double log_falloff(const lensprof_vignetting &v, double r2) {
    return std::log(std::max(lensprof_vignetting_eval(&v, r2, nullptr), 1e-3));
}

bool is_refined_curve(const lensprof_profile &profile) {
    return profile.responses == 1 && profile.response[0].kind == LENSPROF_RESPONSE_TABLE
           && profile.provenance.gamma_sigma > 0.0 && profile.provenance.gamma_sigma < kUninformative;
}

}  // namespace

bool has_uncertainty(const lensprof_profile &profile) {
    const uint32_t n = profile.covariance_size;
    bool is_stated = is_refined_curve(profile);
    for (uint32_t i = 0; i < n; i++) is_stated = is_stated || profile.covariance[i * n + i] > 0.0;
    return is_stated;
}

bool is_covariance(const lensprof_profile &profile) {
    const auto n = static_cast<Eigen::Index>(profile.covariance_size);
    Eigen::VectorXd sigma(n);
    for (Eigen::Index i = 0; i < n; i++) sigma[i] = std::sqrt(profile.covariance[i * n + i]);
    Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index i = 0; i < n; i++)
        for (Eigen::Index j = 0; j < n; j++) {
            const double value = profile.covariance[i * n + j];
            if (i != j && sigma[i] > 0.0 && sigma[j] > 0.0)
                correlation(i, j) = value / sigma[i] / sigma[j];
            else if (i != j && value != 0.0)
                return false;
        }
    if (!correlation.allFinite()) return false;
    constexpr double kRounding = 1e-6;
    correlation.diagonal().array() += kRounding;
    return is_positive_definite(correlation);
}

StoredPrior::StoredPrior(const lensprof_profile &profile, const Problem &problem, int most_modes)
    : vignettings_(static_cast<int>(profile.vignettings)) {
    const bool is_emor = profile.responses == 1 && profile.response[0].kind == LENSPROF_RESPONSE_EMOR;
    const bool is_curve = is_refined_curve(profile);
    if (is_curve) modes_ = std::min(kCurveModes, most_modes);
    if (is_emor) modes_ = std::min(static_cast<int>(profile.response[0].modes), most_modes);
    const int stored = static_cast<int>(profile.covariance_size);
    const uint32_t before = lp_covariance_modes(profile.response, profile.responses);
    const int falloff = static_cast<int>(lp_covariance_index(before, 0)),
              center = static_cast<int>(lp_covariance_index(before, profile.vignettings));
    const auto is_known = [&](int row,
                              int count) {  // held parameters are not known, nor are those correlated with them
        bool all = row + count <= stored;
        for (int i = row; i < row + count && all; i++) all = profile.covariance[i * stored + i] > 0.0;
        return all;
    };
    const Eigen::MatrixXd scatter = scatter_of_all();
    const bool is_of_kind = lp_provenance_doubts_response(&profile.provenance);  // and known without the profile
    if (is_emor && (is_of_kind || !is_known(0, modes_))) modes_ = 0;
    std::vector<int> from, to;  // row of the profile's covariance, column of the full shared vector
    for (int l = 0; l < modes_ && is_emor; l++) from.push_back(l), to.push_back(l);
    for (int i = 0; i < 3 * vignettings_ && is_known(falloff, 3 * vignettings_); i++)
        from.push_back(falloff + i), to.push_back(kFalloff + i);
    for (int d = 0; d < 2 && is_known(center, 2); d++) from.push_back(center + d), to.push_back(kCenter + d);
    for (size_t i = 0; i < from.size(); i++)
        for (size_t j = 0; j < from.size(); j++)
            covariance_(to[i], to[j]) =
                profile.covariance[from[i] * stored + from[j]] + kDrift * kDrift * scatter(to[i], to[j]);
    if (modes_ > 0) {
        const auto coefficients = is_emor && modes_ == static_cast<int>(profile.response[0].modes)
                                      ? std::vector<double>(profile.response[0].emor, profile.response[0].emor + modes_)
                                      : project_curve(profile.response[0].table, modes_);
        for (int l = 0; l < modes_; l++) mean_[l] = coefficients[static_cast<size_t>(l)];
    }
    for (int c = 0; c < vignettings_; c++)
        for (int n = 0; n < 3; n++) mean_[kFalloff + 3 * c + n] = profile.vignetting[c].k[n];
    for (int d = 0; d < 2; d++) mean_[kCenter + d] = profile.vignetting[0].center[d];
    if (is_curve) take_curve_error(problem, profile);
    shares_gamma_ = profile.provenance.gamma_sigma > 0.0;
    find_gamma_errors(problem, profile);
}

// Covariance of the modes on which a refined curve was projected: that of its shape, and that of its gamma along the
// family.
void StoredPrior::take_curve_error(const Problem &problem, const lensprof_profile &profile) {
    if (modes_ == 0) return;
    constexpr double kNoise = kCurveLevels / 255.0 * kCurveLevels / 255.0 * LENSPROF_RESPONSE_SAMPLES;
    const Eigen::MatrixXd scatter = scatter_of_all();
    const Eigen::VectorXd along = Gauge::direction(problem, estimate_of(problem, profile)).head(modes_);
    const double gamma_sigma = profile.provenance.gamma_sigma;
    covariance_.topLeftCorner(modes_, modes_) = gamma_sigma * gamma_sigma * along * along.transpose();
    for (int l = 0; l < modes_; l++) covariance_(l, l) += kNoise + kCurveDrift * kCurveDrift * scatter(l, l);
}

// The profile as an estimate for the problem's pictures.
Estimate StoredPrior::estimate_of(const Problem &problem, const lensprof_profile &profile) const {
    Estimate stored;
    set_response(stored, mean_.data(), modes_);
    for (size_t c = 0; c < 3; c++) stored.vignetting[0][c] = profile.vignetting[profile.vignettings == 3 ? c : 0];
    stored.log_exposure.assign(problem.image_count, {});
    return stored;
}

// ln M of a falloff relative to that of the profile, over the frame: 1 if both are equal, gamma for M^gamma.
double StoredPrior::falloff_ratio(const lensprof_vignetting &v) const {
    const int green = green_falloff(vignettings_);
    const lensprof_vignetting known{{mean_[green], mean_[green + 1], mean_[green + 2]}, {}};
    double product = 0.0, square = 0.0;
    for (double r2 : kRadii2) {
        product += log_falloff(v, r2) * log_falloff(known, r2);
        square += log_falloff(known, r2) * log_falloff(known, r2);
    }
    return square > 0.0 ? product / square : 0.0;
}

// Errors of ln gamma from the response's position and from the falloff's depth, and their covariance: both are linear
// in the profile's parameters.
void StoredPrior::find_gamma_errors(const Problem &problem, const lensprof_profile &profile) {
    const Estimate stored = estimate_of(problem, profile);
    response_position_ = gamma_position(stored.curve.table.data());
    Eigen::VectorXd by_response = Eigen::VectorXd::Zero(kOneSetting), by_falloff = by_response;
    by_response.head(kMaxModes) = gamma_slope(stored);
    const int green = green_falloff(vignettings_);
    for (int n = 0; n < 3; n++) {
        constexpr double h = 1e-5;
        lensprof_vignetting up = profile.vignetting[green_curve(vignettings_)], down = up;
        up.k[n] += h, down.k[n] -= h;
        by_falloff[green + n] = (falloff_ratio(up) - falloff_ratio(down)) / (2 * h);
    }
    const auto sigma = [&](const Eigen::VectorXd &derivative) {
        return std::sqrt(std::max(derivative.dot(covariance_ * derivative), 0.0));
    };
    response_sigma_ = modes_ > 0 ? sigma(by_response) : 0.0;
    falloff_sigma_ = sigma(by_falloff);
    if (!(falloff_sigma_ < kUninformative)) falloff_sigma_ = 0.0;
    gamma_covariance_ = by_response.dot(covariance_ * by_falloff);
    if (is_refined_curve(profile)
        && profile.provenance.images > 0)  // from one fit, which does not store their covariance
        gamma_covariance_ = std::pow(std::min(response_sigma_, falloff_sigma_), 2);
    if (!has_response() && !has_falloff()) return;
    gamma_direction_ = Gauge::direction(problem, stored);
    for (Eigen::Index i = 0; i < kOneSetting; i++)
        if (covariance_(i, i) <= 0.0) gamma_direction_[i] = 0.0;
}

double StoredPrior::gamma_offset(const Estimate &estimate, double &sigma, bool &by_falloff) const {
    constexpr double kMinRatio = 0.05;  // of the ratio: below it, the falloffs are unrelated
    const double of_response = gamma_position(estimate.curve.table.data()) - response_position_,
                 of_falloff = std::log(std::max(falloff_ratio(estimate.vignetting[0][1]), kMinRatio));
    by_falloff = !has_response() || (has_falloff() && falloff_sigma_ < response_sigma_);
    sigma = by_falloff ? falloff_sigma_ : response_sigma_;
    if (!has_response() || !has_falloff()) return by_falloff ? of_falloff : of_response;
    // The minimum variance mean, or only the better of the two if the other adds no information. Errors of falloffs of
    // other settings have heavy tails: if the falloff contradicts the response, it has less weight.
    const double response_variance = response_sigma_ * response_sigma_;
    double falloff_variance = falloff_sigma_ * falloff_sigma_,
           difference_variance = response_variance + falloff_variance - 2.0 * gamma_covariance_;
    if (difference_variance > 0.0)
        falloff_variance *= 1.0 + std::pow(of_response - of_falloff, 2) / difference_variance;
    difference_variance = response_variance + falloff_variance - 2.0 * gamma_covariance_;
    double share = difference_variance > 0.0 ? (falloff_variance - gamma_covariance_) / difference_variance
                                             : 0.5;  // of the response
    share = std::clamp(share, 0.0, 1.0);
    by_falloff = share < 0.5;
    sigma = std::sqrt(share * share * response_variance + (1.0 - share) * (1.0 - share) * falloff_variance
                      + 2.0 * share * (1.0 - share) * gamma_covariance_);
    return share * of_response + (1.0 - share) * of_falloff;
}

// Indices of the known parameters: green's curve if there is one curve; otherwise the curves of the other channels are
// tied to green's.
StoredPrior::Places StoredPrior::places(int vignettings) const {
    Places places;
    const auto take = [&](int source, int target) {
        if (covariance_(source, source) > 0.0) places.from.push_back(source), places.to.push_back(target);
    };
    for (int l = 0; l < modes_; l++) take(l, l);
    const bool all_three = vignettings_ == 3 && vignettings == 3;
    for (int i = 0; i < (all_three ? 9 : 3); i++)
        take((all_three ? kFalloff : green_falloff(vignettings_)) + i,
             (all_three ? kFalloff : green_falloff(vignettings)) + i);
    for (int d = 0; d < 2; d++) take(kCenter + d, kCenter + d);
    return places;
}

// The inverse of the covariance of what is known. If gamma is determined separately, its value is arbitrary here: the
// precision along its direction is removed.
Eigen::MatrixXd StoredPrior::precision_of(const std::vector<int> &from, bool is_gamma_open) const {
    const auto count = static_cast<Eigen::Index>(from.size());
    Eigen::MatrixXd covariance(count, count);
    Eigen::VectorXd direction(count);
    for (Eigen::Index i = 0; i < count; i++) {
        direction[i] = gamma_direction_[from[static_cast<size_t>(i)]];
        for (Eigen::Index j = 0; j < count; j++)
            covariance(i, j) = covariance_(from[static_cast<size_t>(i)], from[static_cast<size_t>(j)]);
    }
    Eigen::MatrixXd precision = inverse_of_symmetric(covariance);
    const Eigen::VectorXd along = precision * direction;
    const double length = direction.dot(along);
    if (is_gamma_open && length > 0.0) precision -= along * along.transpose() / length;
    return 0.5 * (precision + precision.transpose());
}

double StoredPrior::falloff_distance(const lensprof_fit_result &alone) const {
    const int stored_row = green_falloff(vignettings_), size = static_cast<int>(alone.covariance_size);
    const int fitted_row =
        static_cast<int>(lp_covariance_index(alone.response.modes, green_curve(int(alone.vignettings))));
    if (covariance_(stored_row, stored_row) <= 0.0 || size < fitted_row + 3) return 0.0;
    double farthest = 0.0;
    for (double r2 : kRadii2) {
        const double power[3] = {r2, r2 * r2, r2 * r2 * r2};
        double variance = 0.0, difference = 0.0;
        for (int i = 0; i < 3; i++) {
            difference += power[i] * (mean_[stored_row + i] - alone.vignetting[1].k[i]);
            for (int j = 0; j < 3; j++)
                variance += power[i] * power[j]
                            * (covariance_(stored_row + i, stored_row + j)
                               + alone.covariance[(fitted_row + i) * size + fitted_row + j]);
        }
        if (variance > 0.0) farthest = std::max(farthest, std::abs(difference) / std::sqrt(variance));
    }
    return farthest;
}

double StoredPrior::response_distance(const lensprof_fit_result &alone) const {
    if (modes_ == 0) return 0.0;
    const auto size = static_cast<Eigen::Index>(alone.covariance_size);
    const auto modes = std::min(static_cast<Eigen::Index>(alone.response.modes), size);
    const Eigen::Map<const Eigen::MatrixXd> fitted_covariance(alone.covariance, size, size);
    Estimate stored;
    set_response(stored, mean_.data(), modes_);
    return shape_distance({stored.curve.table.data(), covariance_.topLeftCorner(modes_, modes_)},
                          {alone.response.table, fitted_covariance.topLeftCorner(modes, modes)});
}

void StoredPrior::put_into(Prior &prior, int vignettings, double weight, bool is_gamma_open) const {
    const Places places = this->places(vignettings);
    if (modes_ > 0) prior.covariance_weight = 0.0;
    const auto forget = [&](int row) { prior.precision.row(row).setZero(), prior.precision.col(row).setZero(); };
    for (int row : places.to) {
        if (row < kFalloff || row >= kCenter)
            forget(row);
        else
            for (int k = kFalloff; k < kCenter; k++) forget(k);
    }
    const bool tied = vignettings_ == 1 || vignettings == 1;
    for (size_t i = 0; i < places.to.size(); i++) {
        const int row = places.to[i];
        prior.mean[row] = mean_[places.from[i]];
        if (tied && row >= kFalloff && row < kCenter)  // the other channels' curves are expected to equal green's
            for (int c = 0; c < 3; c++) prior.mean[kFalloff + 3 * c + (row - kFalloff) % 3] = prior.mean[row];
    }
    const bool has_falloff =
        std::any_of(places.to.begin(), places.to.end(), [](int row) { return row >= kFalloff && row < kCenter; });
    if (has_falloff) prior.falloff[0] = FalloffPrior{};
    if (tied && has_falloff) tie_channels(weight, vignettings, 0, prior);
    const Eigen::MatrixXd precision = precision_of(places.from, is_gamma_open);
    for (size_t i = 0; i < places.to.size(); i++)
        for (size_t j = 0; j < places.to.size(); j++)
            prior.precision(places.to[i], places.to[j]) +=
                weight * precision(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
}

}  // namespace lensprof
