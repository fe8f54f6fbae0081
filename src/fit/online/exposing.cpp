#include "fit/online/exposing.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/quantile.hpp"

namespace lensprof {
namespace online {
namespace {

constexpr int kRounds = 12;              // of weights
constexpr double kExposureStill = 1e-7;  // of ln exposure, at which they end
constexpr double kFrameCutoff2 = 9.0;    // squared standard errors at which a track has half its weight
constexpr double kOutlier2 = 16.0;       // and at which it contradicts the frame
constexpr double kUniformAges = 3.0;     // squared mean of ages from 0 to any, over their variance
constexpr int kTrims = 3;                // of the scale
constexpr double kLongMemory = 60.0;     // observations that a radiance is a mean of, at most
constexpr double kNoiseShare = 0.1;      // of a frame in the running noise
constexpr double kLeastFrameNoise = 0.2 / 255.0;

// The standard error that the median of absolute residuals implies; those beyond four of them, which are not noise,
// are left out, because they would raise the median. 0 if they are few.
double sigma_of(double *residuals, uint32_t count) {
    double sigma = 0.0;
    for (int n = 0; n < kTrims && count >= kFewest; n++) {
        sigma = kMadToSigma * select(residuals, count, count / 2) * std::sqrt(count / (count - 1.0));
        count = static_cast<uint32_t>(
            std::partition(residuals, residuals + count, [&](double r) { return r * r <= kOutlier2 * sigma * sigma; })
            - residuals);
    }
    return sigma;
}

}  // namespace

// The radiance has an error, so f is expected at its mean plus half of its second derivative times the variance.
// Without that, the errors of new tracks would add up along a chain.
Residual Exposing::residual(uint32_t i, double a) const {
    Residual r;
    const Seen &seen = memory_.seen()[i];
    const Light &light = lights_[seen.slot];
    r.at = predict(state_.camera, light.log_radiance + a + seen.log_falloff);
    const double variance = 1.0 / light.information, curved = 0.5 * r.at.bend * variance;
    r.residual = value(i) - r.at.value - curved;
    r.noise = state_.noise * state_.noise / weight(i);
    r.variance = r.noise + r.at.by_log * r.at.by_log * variance + 2.0 * curved * curved;
    r.counts = is_inside(state_, r.at.value, r.noise) && r.at.by_log > 0.0;
    return r;
}

// Derivative of ln L e of an observation by the globals, at its grey value.
Globals Exposing::slope_of(uint32_t i, const Prediction &at) const {
    Globals slope;
    by_globals(state_.camera, at, static_cast<double>(memory_.seen()[i].r2), memory_.seen()[i].log_falloff, slope);
    return -slope / at.by_log;
}

// The median over tracks.
double Exposing::median_start(uint32_t &count) const {
    double *values = memory_.values();
    count = 0;
    for (uint32_t i = 0; i < count_; i++) {
        if (!is_known(i) || !is_between(value(i))) continue;
        Prediction at;
        values[count++] = log_light_of(state_.camera, value(i), &at) - memory_.seen()[i].log_falloff
                          - lights_[memory_.seen()[i].slot].log_radiance;
    }
    return count ? select(values, count, count / 2) : 0.0;
}

// One round of weighted least squares; returns the change of a.
double Exposing::round(ChannelFit &fit) const {
    double pull = 0.0;
    fit.weight = 0.0, fit.used = 0;
    for (uint32_t i = 0; i < count_; i++) {
        if (!is_known(i)) continue;
        const Residual r = residual(i, fit.a);
        if (!r.counts) continue;
        const double z = r.residual * r.residual / (r.variance * fit.scale2 * kFrameCutoff2),
                     w = 1.0 / ((1.0 + z * z) * r.variance);
        pull += w * r.at.by_log * r.residual, fit.weight += w * r.at.by_log * r.at.by_log;
        fit.used++;
    }
    const double step = fit.weight > 0.0 ? std::clamp(pull / fit.weight, -0.5, 0.5) : 0.0;
    fit.a += step;
    return step;
}

// Robust scale of the residuals, and the running noise.
void Exposing::scale(ChannelFit &fit) const {
    double *values = memory_.values();
    uint32_t count = 0;
    for (uint32_t i = 0; i < count_; i++) {
        if (!is_known(i)) continue;
        const Residual r = residual(i, fit.a);
        if (r.counts) values[count++] = std::abs(r.residual) / std::sqrt(r.variance);
    }
    const double sigma = sigma_of(values, count);
    fit.scale2 = std::max(1.0, sigma * sigma);
}

// Variances and slopes of the final exposure.
void Exposing::measure(ChannelFit &fit) const {
    for (uint32_t i = 0; i < count_; i++) {
        if (!is_known(i)) continue;
        const Residual r = residual(i, fit.a);
        const Light &light = lights_[memory_.seen()[i].slot];
        if (!r.counts) continue;
        const double z = r.residual * r.residual / (r.variance * fit.scale2 * kFrameCutoff2);
        const double p = r.at.by_log, share = p * p / ((1.0 + z * z) * r.variance * fit.weight);
        fit.own += share * share * fit.scale2 * r.noise / (p * p);
        fit.tracks += share * share / light.information;
        fit.slope += share * (slope_of(i, r.at) - light.slope.cast<double>());
    }
    measure_drift(fit);
}

// An exposure e is the mean of those that its tracks saw, plus its own error, so that an error persists in all later
// ones by 1 / their mean age. Errors that all tracks share, because they saw the same frames, cancel out: what remains
// follows the scatter of their ages, and is complete if these are uniform.
void Exposing::measure_drift(ChannelFit &fit) const {
    double sum = 0.0, age = 0.0, age2 = 0.0;
    for (uint32_t i = 0; i < count_; i++) {
        if (!is_known(i)) continue;
        const Residual r = residual(i, fit.a);
        if (!r.counts) continue;
        const double p2 = r.at.by_log * r.at.by_log, share = p2 / (r.variance * fit.weight);
        const double mean = 0.5 * (lights_[memory_.seen()[i].slot].information * r.noise / p2 + 1.0);
        sum += share, age += share * mean, age2 += share * mean * mean;
    }
    if (!(sum > 0.0)) return;
    age /= sum, age2 /= sum;
    const double scatter = kUniformAges * std::max(age2 / (age * age) - 1.0, 0.0);
    fit.drift = fit.own / (age * age) * std::min(scatter, 1.0);
}

bool Exposing::find(ChannelFit &fit) const {
    uint32_t count;
    fit.a = median_start(count);
    if (count < kFewest) return false;
    for (int n = 0; n < kRounds; n++) {
        scale(fit);
        if (std::abs(round(fit)) < kExposureStill && n > 2) break;
    }
    if (fit.used < kFewest || !(fit.weight > 0.0)) return false;
    measure(fit);
    return true;
}

void Exposing::mark(const ChannelFit &fit) const {
    double *values = memory_.values();
    uint32_t count = 0;
    for (uint32_t i = 0; i < count_; i++) {
        if (!is_known(i)) continue;
        const Residual r = residual(i, fit.a);
        if (!r.counts) continue;
        const double z = r.residual * r.residual / r.variance;
        if (z > kOutlier2 * fit.scale2) memory_.seen()[i].outlier = 1;
        values[count++] = std::sqrt(z * weight(i) * r.noise);
    }
    if (count < kFewest) return;
    const double noise = std::max(sigma_of(values, count), kLeastFrameNoise);
    state_.noise += kNoiseShare / state_.channels * (noise - state_.noise);
}

namespace {

// From the likeliest radiance of a single observation to the mean of those that its noise allows (third derivative of
// the log likelihood).
double first_shift(const Prediction &at, double information) {
    const double most = 0.5 / std::sqrt(information);
    return std::clamp(1.5 * at.bend / (at.by_log * information), -most, most);
}

}  // namespace

void Exposing::teach(const ChannelFit &fit) const {
    for (uint32_t i = 0; i < count_; i++) {
        const Seen &seen = memory_.seen()[i];
        if (!seen.usable || seen.outlier) continue;
        Light &light = lights_[seen.slot];
        const bool is_new = !(light.information > 0.0);
        Residual r;
        if (is_new) {
            light.log_radiance = log_light_of(state_.camera, value(i), &r.at) - seen.log_falloff - fit.a;
            r.counts = is_between(value(i)) && r.at.by_log > 0.0;
        } else {
            r = residual(i, fit.a);
        }
        if (!r.counts) continue;
        const double p = r.at.by_log,
                     z = is_new ? 0.0 : r.residual * r.residual / (r.variance * fit.scale2 * kFrameCutoff2);
        const double shown = p * p * weight(i) / (state_.noise * state_.noise * fit.scale2 * (1.0 + z * z));
        const double gain = shown / (light.information + shown);
        const Globals slope = slope_of(i, r.at) - fit.slope;
        light.log_radiance += gain * r.residual / p;
        if (is_new) light.log_radiance -= first_shift(r.at, shown);
        light.slope += static_cast<float>(gain) * (slope.cast<float>() - light.slope);
        light.information = std::min(light.information + shown, std::max(light.information, kLongMemory * shown));
    }
}

}  // namespace online
}  // namespace lensprof
