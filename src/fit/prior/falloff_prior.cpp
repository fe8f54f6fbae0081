#include "fit/prior/falloff_prior.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

namespace lensprof {
namespace {

constexpr double kRadius[3] = {0.5, 0.75, 1.0};  // as in make_falloff_prior.py
constexpr double kSmallerSensor = 1.2;           // crop factor, as in make_falloff_prior.py
constexpr double kLowestM = 1e-3;
constexpr double kNothing = 1e-4;  // precision of u that adds no information: a standard error of 100

// Pictures whose camera corrected the falloff: M within some per cent of 1. Nobody has counted them; one in seven.
constexpr double kCorrectedShare = 1.0 / 7.0;
constexpr double kCorrectedSigma[3] = {0.010, 0.018, 0.030}, kCorrectedCorrelation = 0.9;

struct Component {
    double share;
    Eigen::Vector3d mean;
    Eigen::Matrix3d scatter;
    bool has_tails;  // a t distribution
};

constexpr int kCount = kSensorClassCount * kStopClassCount + 1;
using Mixture = std::array<Component, kCount>;

// Shares of the classes of stops: a linear transition from one to the next if they are known, else equal parts.
double share_of_stops(int of_class, double stops) {
    if (stops == LENSPROF_UNKNOWN) return 1.0 / kStopClassCount;
    const double place = std::clamp(stops, 0.0, kStopClassCount - 1.0);
    return std::max(0.0, 1.0 - std::abs(place - of_class));
}

double share_of_sensor(int of_class, double crop_factor) {
    if (crop_factor == LENSPROF_UNKNOWN) return 1.0 / kSensorClassCount;
    return (of_class == 0) == (crop_factor < kSmallerSensor) ? 1.0 : 0.0;
}

Mixture mixture_of(const LensFacts &lens) {
    Mixture mixture;
    size_t n = 0;
    for (int sensor = 0; sensor < kSensorClassCount; sensor++)
        for (int stop = 0; stop < kStopClassCount; stop++) {
            const FalloffClass &of_class = kFalloffClasses[sensor][stop];
            const double share = share_of_sensor(sensor, lens.crop_factor) * share_of_stops(stop, lens.stops);
            mixture[n++] = {(1.0 - kCorrectedShare) * share, Eigen::Vector3d::Map(of_class.mean),
                            Eigen::Map<const Eigen::Matrix3d>(&of_class.scatter[0][0]), true};
        }
    Component &corrected = mixture.back();
    corrected = {kCorrectedShare, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), false};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            corrected.scatter(i, j) = kCorrectedSigma[i] * kCorrectedSigma[j] * (i == j ? 1.0 : kCorrectedCorrelation);
    return mixture;
}

// The normal distribution with the mean of the mixture, and its covariance with the scatter of each component. The
// variance of a t distribution is twice its scatter at 4 degrees of freedom, but due to its tails: the middle, which
// counts unless pictures are far off, has the scatter.
FalloffPrior moments_of(const Mixture &mixture) {
    double total = 0.0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Component &part : mixture) total += part.share, mean += part.share * part.mean;
    mean /= total;
    for (const Component &part : mixture) {
        const Eigen::Vector3d off = part.mean - mean;
        covariance += part.share / total * (part.scatter + off * off.transpose());
    }
    return {mean, covariance.inverse()};
}

// Squared distance between the pictures and a component, in the covariance of both, and that covariance's inverse.
double distance2_of(const Component &part, const Eigen::Matrix3d &shown, const Eigen::Vector3d &u,
                    Eigen::Matrix3d &inverse) {
    inverse = (part.scatter + shown).inverse();
    const Eigen::Vector3d off = u - part.mean;
    return off.dot(inverse * off);
}

}  // namespace

Eigen::Vector3d log_falloff(const double k[3], Eigen::Matrix3d *slope) {
    Eigen::Vector3d u;
    for (int i = 0; i < 3; i++) {
        const double r2 = kRadius[i] * kRadius[i];
        const double m = std::max(1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[2])), kLowestM);
        u[i] = std::log(m);
        if (slope) slope->row(i) << r2 / m, r2 * r2 / m, r2 * r2 * r2 / m;
    }
    return u;
}

FalloffPrior expected_falloff(const LensFacts &lens) { return moments_of(mixture_of(lens)); }

FalloffPrior falloff_given(const ShownFalloff &shown, const LensFacts &lens, double &distance) {
    const Eigen::Matrix3d precision = shown.precision + kNothing * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d covariance = precision.inverse();
    const Eigen::Vector3d u = covariance * shown.weighted;
    Mixture mixture = mixture_of(lens);
    std::array<double, kCount> log_density{}, distance2{};
    double highest = -HUGE_VAL, nearest2 = HUGE_VAL;
    for (size_t n = 0; n < kCount; n++) {
        const Component &part = mixture[n];
        Eigen::Matrix3d both;
        distance2[n] = distance2_of(part, covariance, u, both);
        const double tail = part.has_tails ? 0.5 * (kFalloffFreedom + 3.0) * std::log1p(distance2[n] / kFalloffFreedom)
                                           : 0.5 * distance2[n];
        log_density[n] =
            part.share > 0.0 ? std::log(part.share) + 0.5 * std::log(both.determinant()) - tail : -HUGE_VAL;
        highest = std::max(highest, log_density[n]);
        if (part.share > 0.0) nearest2 = std::min(nearest2, distance2[n]);
    }
    distance = std::sqrt(nearest2);
    for (size_t n = 0; n < kCount; n++) {
        Component &part = mixture[n];
        // A t distribution about pictures that are far from it is as wide as that of the scale that explains them best.
        if (part.has_tails) part.scatter *= std::max(1.0, (kFalloffFreedom + distance2[n]) / (kFalloffFreedom + 3.0));
        part.share = std::exp(log_density[n] - highest);
    }
    return moments_of(mixture);
}

}  // namespace lensprof
