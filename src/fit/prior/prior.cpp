#include "fit/prior/prior.hpp"

#include <cmath>

#include <Eigen/LU>

#include <lensprof/profile.h>

#include "falloff/dense.hpp"

namespace lensprof {

const double kEmorSigma[kMaxModes] = {3.416,  1.294,  0.469,  0.202,  0.0961, 0.0706, 0.0520, 0.0371, 0.0368,
                                      0.0303, 0.0194, 0.0143, 0.0103, 0.0085, 0.0069, 0.0055, 0.0049, 0.0049,
                                      0.0035, 0.0030, 0.0029, 0.0019, 0.0018, 0.0016, 0.0014};

namespace {

// Covariance of (k1, k2, k3) over the 19,920 falloff entries of Lensfun's database.
const double kFalloffCovariance[3][3] = {
    {0.1298, -0.1369, 0.0682}, {-0.1369, 0.3262, -0.2656}, {0.0682, -0.2656, 0.4005}};

// Falloff curves of the channels relative to that of green: lateral colour and sensor stacks.
constexpr double kChannelSigma = 0.1;

}  // namespace

Prior make_prior(double weight, int vignettings, int settings, bool by_covariance) {
    const int size = shared_size(settings);
    Prior prior;
    prior.covariance_weight = by_covariance ? weight : 0.0;
    prior.mean = Eigen::VectorXd::Zero(size);
    prior.precision = Eigen::MatrixXd::Zero(size, size);
    prior.falloff.resize(static_cast<size_t>(settings));
    for (int l = 0; l < kMaxModes; l++) prior.precision(l, l) = weight / (kEmorSigma[l] * kEmorSigma[l]);
    const LensKnowledge any{expected_falloff({}), weight, weight};
    for (int s = 0; s < settings; s++) set_lens(any, vignettings, s, prior);
    return prior;
}

LensFacts facts_of(const Problem &problem, int setting) {
    const auto mean_of = [&](auto value) {  // geometric
        double sum = 0.0, count = 0.0;
        for (uint32_t i = 0; i < problem.image_count; i++)
            if (problem.setting_of[i] == setting && value(problem.images[i]) > 0.0)
                sum += std::log2(value(problem.images[i])), count += 1.0;
        return count > 0.0 ? std::exp2(sum / count) : LENSPROF_UNKNOWN;
    };
    const double ratio = mean_of([](const lensprof_fit_image &image) { return image.f_number_ratio; });
    const double crop = mean_of([](const lensprof_fit_image &image) { return image.crop_factor; });
    return {ratio == LENSPROF_UNKNOWN ? ratio : 2.0 * std::log2(ratio), crop};
}

void set_lens(const LensKnowledge &lens, int vignettings, int setting, Prior &prior) {
    const int first = falloff_column(setting), center = center_column(setting);
    prior.precision.block(first, first, kSetting, kSetting).setZero();
    prior.mean.segment(first, kSetting).setZero();
    tie_channels(lens.falloff_weight, vignettings, setting, prior);
    for (int d = 0; d < 2; d++)
        prior.precision(center + d, center + d) = lens.center_weight / (kCenterSigma * kCenterSigma);
    FalloffPrior &falloff = prior.falloff[static_cast<size_t>(setting)];
    falloff = lens.falloff;
    falloff.precision *= lens.falloff_weight;
}

void make_falloff_linear(int vignettings, Prior &prior) {
    FalloffPrior &falloff = prior.falloff[0];
    const double flat[3] = {0.0, 0.0, 0.0};
    Eigen::Matrix3d slope;
    log_falloff(flat, &slope);  // of M itself, since M is 1
    const Eigen::Vector3d k = slope.inverse() * (falloff.mean.array().exp() - 1.0).matrix();
    log_falloff(k.data(), &slope);
    const int green = green_falloff(vignettings);
    prior.precision.block<3, 3>(green, green) += slope.transpose() * falloff.precision * slope;
    for (int column = kFalloff; column < kCenter; column++) prior.mean[column] = k[(column - kFalloff) % 3];
    falloff = FalloffPrior{};
}

void tie_channels(double weight, int vignettings, int setting, Prior &prior) {
    const int first = falloff_column(setting), green = green_falloff(vignettings, setting);
    const double tie = weight / (kChannelSigma * kChannelSigma);
    for (int column = first; column < first + 3 * vignettings; column++) {
        const int of_green = green + (column - first) % 3;
        if (column == of_green) continue;
        prior.precision(column, column) += tie;
        prior.precision(of_green, of_green) += tie;
        prior.precision(column, of_green) = prior.precision(of_green, column) = -tie;
    }
}

Eigen::MatrixXd scatter_of_all() {
    Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(kOneSetting, kOneSetting);
    for (int l = 0; l < kMaxModes; l++) scatter(l, l) = kEmorSigma[l] * kEmorSigma[l];
    for (int a = 0; a < 9; a++)
        for (int b = 0; b < 9; b++) scatter(kFalloff + a, kFalloff + b) = kFalloffCovariance[a % 3][b % 3];
    for (int d = 0; d < 2; d++) scatter(kCenter + d, kCenter + d) = kCenterSigma * kCenterSigma;
    return scatter;
}

Prior prior_of(const Prior &prior, int modes) {
    Prior result = prior;
    if (prior.covariance_weight == 0.0 || modes <= 0) return result;
    Eigen::MatrixXd covariance(modes, modes);
    for (int l = 0; l < modes; l++)
        for (int m = 0; m <= l; m++)
            covariance(l, m) = covariance(m, l) =
                kEmorSigma[l] * kEmorSigma[m] * (l == m ? 1.0 : kEmorCorrelation[l * (l - 1) / 2 + m]);
    result.precision.topLeftCorner(modes, modes) = prior.covariance_weight * inverse_of_positive(covariance);
    return result;
}

double prior_cost(const Prior &prior, const Problem &problem, const std::vector<int> &columns,
                  const Estimate &estimate) {
    Eigen::VectorXd full = shared_vector(estimate), d = Eigen::VectorXd::Zero(full.size());
    for (int column : columns) d[column] = full[column] - prior.mean[column];
    double cost = 0.5 * d.dot(prior.precision * d);
    for (size_t s = 0; s < prior.falloff.size() && (problem.free & LENSPROF_FREE_FALLOFF); s++) {
        const Eigen::Vector3d off =
            log_falloff(estimate.vignetting[s][green_curve(problem.vignettings)].k, nullptr) - prior.falloff[s].mean;
        cost += 0.5 * off.dot(prior.falloff[s].precision * off);
    }
    if (prior.pin_precision > 0.0) {
        double off = prior.pin.dot(full.head(kMaxModes)) - prior.pin_value;
        cost += 0.5 * prior.pin_precision * off * off;
    }
    for (size_t i = 0; i < prior.known.size(); i++) {
        double off = estimate.log_exposure[i][problem.measured_channel()] - prior.known[i].log_exposure;
        if (problem.ev_unknown[i] >= 0) cost += 0.5 * prior.known[i].precision * off * off;
    }
    return cost;
}

}  // namespace lensprof
