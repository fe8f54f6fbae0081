#include "fit/prior/gauge.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include "core/response.h"

#include "falloff/power_fit.hpp"
#include "fit/base/constants.hpp"
#include "fit/problem/curve_shape.hpp"

namespace lensprof {
namespace {

// How firmly gamma is held, as a standard error of ln gamma at kPinPairs pairs. Modes left out prefer some gamma by
// accident, and more strongly with more pairs, so the hold scales with their number. Over simulated cameras, a hold of
// 0.05 to 0.1 left gamma to that accident (median error 0.14, against 0.05 with this hold), with held-out pairs better
// by half a percent.
constexpr double kPinSigma = 1e-3, kSmallestPinSigma = 2e-4, kLargestPinSigma = 0.01, kPinPairs = 20000.0;
constexpr double kLooseSigma = 0.07;  // of a response that is moved to its gamma exactly afterwards
constexpr double kLargestStep = 1.2;  // of ln gamma in one move along the family

// Whether exposures or white balances of images are held at values other than the reference's.
bool has_fixed_exposure(const Problem &problem) {
    auto given = [&](uint32_t i, int c) {  // log exposure from which the unknowns of channel c start
        lensprof_exposure e = given_exposure(problem.images, i);
        return problem.channels == 1 ? e.ev * kLn2 : e.ev * kLn2 + std::log(e.white_balance[c]);
    };
    for (uint32_t i = 0; i < problem.image_count; i++)
        for (int c = 0; c < problem.channels; c++)
            if (problem.ev_unknown[i] < 0 && problem.balance_unknown[i][c] < 0
                && given(i, c) != given(problem.reference, c))
                return true;
    return false;
}

// Whether no held value distinguishes one member of the family from another.
bool nothing_fixes_gamma(const lensprof_fit_options &options, const Problem &problem) {
    for (int n = 0; n < 3; n++)
        if (!(options.free & (LENSPROF_FREE_K1 << n)) && options.vignetting.k[n] != 0.0) return false;
    return (options.free & LENSPROF_FREE_RESPONSE) && options.modes != 0 && !has_fixed_exposure(problem);
}

// Two values of ln gamma with their standard errors, of which those of falloffs have heavy tails: if the two contradict
// each other, the falloff has less weight.
struct Weighed {
    double kind, falloff;  // precisions

    Weighed(double off, double kind_sigma, double falloff_sigma) {
        const double z = off / std::hypot(kind_sigma, falloff_sigma);
        kind = 1.0 / (kind_sigma * kind_sigma), falloff = 1.0 / (falloff_sigma * falloff_sigma * (1.0 + z * z));
    }
    double mean(double of_kind, double of_falloff, double &sigma) const {
        sigma = 1.0 / std::sqrt(kind + falloff);
        return (kind * of_kind + falloff * of_falloff) / (kind + falloff);
    }
};

}  // namespace

void raise_falloff(uint32_t free, double gamma, lensprof_vignetting &v) {
    constexpr int kRadii = 40;
    std::vector<int> powers;  // of r^2
    for (int n = 0; n < 3; n++)
        if (free & (LENSPROF_FREE_K1 << n)) powers.push_back(n + 1);
    if (powers.empty()) return;
    const lensprof_vignetting given = v;
    const Eigen::VectorXd k = fit_powers(powers.data(), static_cast<int>(powers.size()), kRadii, 0, [&](int i) {
        const double r2 = (i + 1) * (i + 1) / double(kRadii * kRadii);
        const double m = std::max(lensprof_vignetting_eval(&given, r2, nullptr), 1e-3);
        return PowerSample{r2, std::pow(m, gamma) - 1.0, 1.0};
    });
    for (size_t u = 0; u < powers.size(); u++) v.k[powers[u] - 1] = k[static_cast<Eigen::Index>(u)];
}

Eigen::VectorXd gamma_slope(const Estimate &estimate) {
    Eigen::VectorXd by_mode;
    gamma_position(estimate.curve.table.data(), &by_mode);
    for (int l = std::max(estimate.modes, 0); l < kMaxModes; l++) by_mode[l] = 0.0;
    return by_mode;
}

Estimate with_exponent(const Problem &problem, const Estimate &estimate, double log_gamma) {
    Estimate moved = estimate;
    double gamma = std::exp(log_gamma), curve[LENSPROF_RESPONSE_SAMPLES];
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++)
        curve[j] = lp_curve_eval(estimate.curve.table.data(), std::pow(j / 1023.0, 1.0 / gamma), nullptr);
    if (estimate.modes >= 0)
        set_response(moved, project_curve(curve, estimate.modes).data(), estimate.modes);
    else
        set_table(moved, curve);
    for (Falloffs &curves : moved.vignetting)
        for (auto &v : curves) raise_falloff(problem.free, gamma, v);
    const auto &reference = estimate.log_exposure[problem.reference];
    for (auto &a : moved.log_exposure)
        for (size_t c = 0; c < 3; c++) a[c] = reference[c] + gamma * (a[c] - reference[c]);
    return moved;
}

Gauge::Gauge(const lensprof_fit_options &options, const Problem &problem, const StoredPrior *stored)
    : prior_(options.camera_kind),
      stored_(stored && (stored->has_response() || stored->has_falloff()) ? stored : nullptr),
      wanted_(static_cast<lensprof_gamma_from>(options.gamma_from)) {
    bool is_family = nothing_fixes_gamma(options, problem);
    open_ = is_family && options.prior_weight > 0.0;
    if (is_family && !open_) from_ = LENSPROF_GAMMA_NONE;
    if (open_ && !is_static(problem) && (options.free & LENSPROF_FREE_FALLOFF) == LENSPROF_FREE_FALLOFF) {
        const FalloffPrior lens = expected_falloff(facts_of(problem, 0));
        depth_ = -lens.mean[2];
        depth_sigma_ = std::sqrt(lens.precision.inverse()(2, 2)) / depth_;
    }
    bool any = false;
    for (uint32_t i = 0; i < problem.image_count; i++) any = any || problem.images[i].known_ev_sigma > 0.0;
    if (any) known_weight_.assign(problem.image_count, 1.0);
}

Gauge Gauge::unconstrained() const {
    Gauge result = *this;
    result.open_ = false;
    result.known_weight_.clear();
    return result;
}

Gauge Gauge::by_prior() const {
    Gauge other = *this;
    other.wanted_ = LENSPROF_GAMMA_PRIOR;
    other.is_loose_ = true;
    other.known_weight_.clear();
    return other;
}

// Distance to the gamma of cameras of the kind, and of lenses: M^gamma is deeper than that of most if gamma is large.
double Gauge::expected_of_kind(const Problem &problem, const Estimate &estimate, double &sigma) const {
    constexpr double kShallowest = 0.02;  // depth: corrected falloffs, all alike
    const double *table = estimate.curve.table.data();
    const double of_kind = gamma_position(table) - prior_.position();
    sigma = prior_.sigma_of(table);
    if (!(depth_sigma_ > 0.0)) return of_kind;
    const double *k = estimate.vignetting[0][green_curve(problem.vignettings)].k;
    const double depth = std::max(-log_falloff(k, nullptr)[2], kShallowest);
    const double of_lenses = std::log(depth / depth_);
    return Weighed(of_kind - of_lenses, sigma, depth_sigma_).mean(of_kind, of_lenses, sigma);
}

// Distance to the gamma expected from cameras of the kind, or from the profile. A response's own gamma replaces that of
// the kind, which it may include. A falloff alone is combined with that of the kind, unless its gamma may come from
// there.
double Gauge::expected(const Problem &problem, const Estimate &estimate, double &sigma,
                       lensprof_gamma_from &from) const {
    from = LENSPROF_GAMMA_PRIOR;
    if (!stored_) return expected_of_kind(problem, estimate, sigma);
    const double *table = estimate.curve.table.data();
    const double of_kind = gamma_position(table) - prior_.position(), kind_sigma = prior_.sigma_of(table);
    bool by_falloff;
    const double of_stored = stored_->gamma_offset(estimate, sigma, by_falloff), stored_sigma = sigma;
    from = by_falloff ? LENSPROF_GAMMA_FALLOFF : LENSPROF_GAMMA_PROFILE;
    if (stored_->has_response()) return of_stored;
    const bool is_of_kind = kind_sigma < stored_sigma;
    if (is_of_kind) from = LENSPROF_GAMMA_PRIOR;
    if (stored_->shares_gamma()) {
        sigma = std::min(kind_sigma, stored_sigma);
        return is_of_kind ? of_kind : of_stored;
    }
    const Weighed weighed(of_kind - of_stored, kind_sigma, stored_sigma);
    from = weighed.kind > weighed.falloff ? LENSPROF_GAMMA_PRIOR : LENSPROF_GAMMA_FALLOFF;
    return weighed.mean(of_kind, of_stored, sigma);
}

double Gauge::contradiction(const Estimate &estimate) const {
    if (!stored_) return 0.0;
    const double *table = estimate.curve.table.data();
    double sigma;
    bool by_falloff;
    const double of_stored = stored_->gamma_offset(estimate, sigma, by_falloff);
    return std::abs(gamma_position(table) - prior_.position() - of_stored) / std::hypot(prior_.sigma_of(table), sigma);
}

// Distance to the gamma expected from the prior and known exposures, each weighted by its standard error.
double Gauge::distance(const Problem &problem, const Estimate &estimate) {
    compare_known(problem, estimate);
    if (!open_) return 0.0;
    lensprof_gamma_from expected_from;
    const double offset = expected(problem, estimate, expected_sigma_, expected_from);
    bool is_informative = slope_sigma_ > 0.0 && wanted_ != LENSPROF_GAMMA_PRIOR;
    double expected_precision = 1.0 / (expected_sigma_ * expected_sigma_);
    if (is_informative) {  // errors of the prior have heavy tails: if exposures contradict it, it has less weight
        double z = (offset - std::log(slope_)) / std::hypot(expected_sigma_, slope_sigma_);
        if (expected_from != LENSPROF_GAMMA_PRIOR) z /= kDoubtful;  // those of a profile do not
        expected_precision *= wanted_ == LENSPROF_GAMMA_EXPOSURES ? 0.0 : 1.0 / (1.0 + z * z);
    }
    double precision = is_informative ? 1.0 / (slope_sigma_ * slope_sigma_) : 0.0;
    from_ = precision > expected_precision ? LENSPROF_GAMMA_EXPOSURES : expected_from;
    oddness_ = prior_.oddness(estimate.curve.table.data());
    sigma_ = 1.0 / std::sqrt(precision + expected_precision);
    missed_ = (expected_precision * offset + precision * std::log(slope_)) / (precision + expected_precision);
    return missed_;
}

void Gauge::apply_gamma(const Problem &problem, Estimate &estimate) {
    if (!open_) return;
    for (int round = 0; round < 3; round++) {
        double step = -std::clamp(distance(problem, estimate), -kLargestStep, kLargestStep);
        if (std::abs(step) < 0.01) return;
        Estimate moved = with_exponent(problem, estimate, step);
        for (int half = 0; half < 6; half++) {
            if (is_feasible(moved, problem.vignettings)) break;
            step *= 0.5;
            moved = with_exponent(problem, estimate, step);
        }
        if (!is_feasible(moved, problem.vignettings)) return;
        estimate = moved;
    }
}

void Gauge::renew(const Problem &problem, const Estimate &estimate, Prior &prior) {
    prior.pin.setZero();
    prior.pin_precision = prior.pin_value = 0.0;
    if (open_) {
        double current = distance(problem, estimate);
        prior.pin = gamma_slope(estimate);
        double pairs = static_cast<double>(std::max<size_t>(problem.pairs.size(), 1));
        double hold = std::clamp(kPinSigma * std::sqrt(kPinPairs / pairs), kSmallestPinSigma, kLargestPinSigma);
        // A gamma known better than by the prior is held more firmly.
        const double better = std::pow(sigma_ / expected_sigma_, 4);
        hold = std::max(hold * better, std::min(hold, kPinSigma));
        if (is_loose_) hold = kLooseSigma;
        prior.pin_precision = 1.0 / (hold * hold);
        prior.pin_value = prior.pin.dot(Eigen::Map<const Eigen::VectorXd>(estimate.emor.data(), kMaxModes)) - current;
    } else {
        compare_known(problem, estimate);
    }
    put_known(problem, prior);
    if (expects_equal_) put_equal(problem, estimate, prior);
}

Eigen::VectorXd Gauge::direction(const Problem &problem, const Estimate &estimate) {
    constexpr double h = 0.01;
    Eigen::VectorXd up = shared_vector(with_exponent(problem, estimate, h));
    return (up - shared_vector(with_exponent(problem, estimate, -h))) / (2 * h);
}

}  // namespace lensprof
