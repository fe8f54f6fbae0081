#include "fit/online/exponent.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {
namespace online {
namespace {

constexpr double kLeastKnownSigma = 0.02;  // EV, as fit/prior/gauge.hpp
constexpr double kLargestLogGamma = 2.3;
constexpr uint32_t kLongestStretch = 256;  // known exposures that have one offset: drift of the chain counts as another
constexpr uint32_t kShortestStretch = 30;
constexpr double kAboutMean =
    1.0 / 3.0;                      // of a random walk: the variance about its mean, over the mean of the variance
constexpr double kMostNoise = 0.5;  // share of the scatter of exposures that is taken as their errors, at most
constexpr int kGammaSteps = 20;
enum {
    kOne,
    kKnown,
    kExposure,
    kSlope
};

Moments about_mean(const Moments &moments) {
    if (!(moments(kOne, kOne) > 0.0)) return Moments::Zero();
    return moments - moments.col(kOne) * moments.row(kOne) / moments(kOne, kOne);
}

}  // namespace

void add_known(double ev, double sigma, const Exposed &exposed, Exponent &exponent) {
    Eigen::Matrix<double, kMoments, 1> row;
    row << 1.0, ev, exposed.log_exposure / kLn2, exposed.slope / kLn2;
    const double error = std::max(sigma, kLeastKnownSigma);
    const double unit = 1.0 / (kLn2 * kLn2 * error * error), drift = exposed.chain - exponent.begun;
    const bool drifts = exponent.chain_count > kShortestStretch && drift * unit * exponent.chain_count > 1.0;
    if (drifts || exponent.chain_count >= kLongestStretch) end_chain(exponent);
    if (!exponent.chain_count) exponent.begun = exposed.chain;
    exponent.noise +=
        unit * (exposed.own + exposed.tracks + kAboutMean * std::max(exposed.chain - exponent.begun, 0.0));
    exponent.chain += row * row.transpose() / (error * error);
    exponent.known += 1.0, exponent.chain_count++;
}

void end_chain(Exponent &exponent) {
    if (!(exponent.chain(kOne, kOne) > 0.0)) return;
    exponent.earlier += about_mean(exponent.chain);
    exponent.chain.setZero();
    exponent.chains += 1.0, exponent.chain_count = 0;
}

void follow(const Globals &step, Exponent &exponent) {
    Moments move = Moments::Identity();
    move.row(kExposure).tail<kGlobals>() = step.transpose();
    exponent.chain = (move * exponent.chain * move.transpose()).eval();
    exponent.earlier = (move * exponent.earlier * move.transpose()).eval();
}

// The known exposures K are gamma a + an offset per chain. Newton's method for ln gamma, with its prior.
Gamma gamma_of(const Exponent &exponent) {
    Gamma gamma{0.0, exponent.log_gamma_sigma * exponent.log_gamma_sigma, Globals::Zero(), 0.0};
    const Moments sums = exponent.earlier + about_mean(exponent.chain);
    const double ak = sums(kExposure, kKnown), kk = sums(kKnown, kKnown), measured = sums(kExposure, kExposure),
                 aa = measured - std::min(exponent.noise, kMostNoise * measured);
    const double freedom = exponent.known - exponent.chains - 2.0;
    if (!(aa > 0.0) || !(freedom > 0.0)) return gamma;
    const double best = ak / aa, scatter2 = std::max(kk - best * ak, 0.0) / freedom;
    gamma.scatter = std::sqrt(scatter2);
    if (!(gamma.variance > 0.0)) return gamma;
    const double prior = 1.0 / gamma.variance, unit = 1.0 / std::max(scatter2, 1.0);
    double shown = 0.0;
    for (int n = 0; n < kGammaSteps; n++) {
        const double g = std::exp(gamma.log_gamma);
        shown = g * g * aa * unit;
        const double step = -(gamma.log_gamma * prior + (g * g * aa - g * ak) * unit) / (prior + shown);
        gamma.log_gamma = std::clamp(gamma.log_gamma + step, -kLargestLogGamma, kLargestLogGamma);
    }
    gamma.variance = 1.0 / (prior + shown);
    gamma.slope = -shown * gamma.variance / aa * sums.col(kExposure).tail<kGlobals>();
    return gamma;
}

double raised_variance(const Gamma &gamma, const GlobalMatrix &covariance, double a, double own, const Globals &slope) {
    const double g = std::exp(gamma.log_gamma);
    const Globals total = slope + a * gamma.slope;
    return g * g * (own + a * a * gamma.variance + total.dot(covariance * total));
}

}  // namespace online
}  // namespace lensprof
