#include "fit/online/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <Eigen/LU>

#include "core/response.h"
#include "fit/online/camera.hpp"
#include "fit/online/exponent.hpp"

namespace lensprof {
namespace online {
namespace {

constexpr double kCertainExponent = 0.05, kCertainShape = 0.01, kCertainFalloff = 0.02;
constexpr double kShapeGreys[] = {0.25, 0.5, 0.75};
constexpr int kRadii = 64;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// ln M in the corner, and its derivatives by the globals.
double corner_of(const Camera &camera, Globals &slope) {
    const double log_m = log_falloff_of(camera, 1.0);
    slope.setZero();
    slope.tail<3>().setConstant(std::exp(-log_m));
    return log_m;
}

// By the scatter of the tracks, and by the modes that the fit omits. What these change by the modes of the fit is left
// out, because it mostly cancels the former.
double shape_variance(const State &state) {
    double largest = 0.0;
    for (double grey : kShapeGreys) {
        Prediction at;
        Globals slope;
        log_light_of(state.camera, grey, &at);
        by_globals(state.camera, at, 0.0, 0.0, slope);
        const double moved = (state.moved.transpose() * slope).squaredNorm(),
                     omitted = omitted_by_sigma(state, at).squaredNorm(),
                     variance = slope.dot(state.covariance * slope) - moved + omitted;
        largest = std::max(largest, variance);
    }
    return largest;
}

uint32_t known_of(const lensprof_online_result &result) {
    uint32_t known = 0;
    if (result.log_gamma_sigma <= kCertainExponent) known |= LENSPROF_ONLINE_KNOWS_EXPONENT;
    if (result.shape_sigma <= kCertainShape) known |= LENSPROF_ONLINE_KNOWS_SHAPE;
    if (result.falloff_sigma <= kCertainFalloff) known |= LENSPROF_ONLINE_KNOWS_FALLOFF;
    return known;
}

// The members of the covariance: k1..k3 and the modes of a response, by the globals and the exponent.
constexpr int kOut = LENSPROF_EMOR_MODES + 3;
using OutSlope = Eigen::Matrix<double, kOut, kGlobals + 1>;

// f(x^(1/gamma)) at all samples, and its EMoR coefficients with their derivatives: the modes are orthonormal.
void raise_response(const Camera &camera, double gamma, double *table, double *emor, OutSlope &slope) {
    std::fill_n(emor, LENSPROF_EMOR_MODES, 0.0);
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) {
        const double x = static_cast<double>(j) / LP_CURVE_LAST, log_x = std::log(std::max(x, 1e-12)) / gamma;
        const Prediction at = predict(camera, j ? log_x : -1e3);
        Globals by_mode;
        by_globals(camera, at, 0.0, 0.0, by_mode);
        table[j] = at.value;
        for (int l = 0; l < LENSPROF_EMOR_MODES; l++) {
            const double h = lensprof_emor_table(static_cast<uint32_t>(l) + 1)[j];
            emor[l] += h * (at.value - lensprof_emor_table(0)[j]);
            slope.row(l).head<kGlobals>() += h * by_mode.transpose();
            slope(l, kGlobals) -= h * at.by_log * log_x;  // by ln gamma
        }
    }
    table[0] = 0.0, table[LP_CURVE_LAST] = 1.0;
}

// The k1..k3 nearest to M^gamma over r^2.
Eigen::Vector3d raise_corner(const Camera &camera, double gamma, OutSlope &slope) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    Eigen::Matrix<double, 3, 4> change = Eigen::Matrix<double, 3, 4>::Zero();
    for (int i = 1; i <= kRadii; i++) {
        const double r2 = static_cast<double>(i) / kRadii, log_m = log_falloff_of(camera, r2),
                     m = std::exp(gamma * log_m);
        const Eigen::Vector3d powers(r2, r2 * r2, r2 * r2 * r2);
        normal += powers * powers.transpose(), right += (m - 1.0) * powers;
        change.leftCols<3>() += gamma * m * std::exp(-log_m) * powers * powers.transpose();
        change.col(3) += m * gamma * log_m * powers;
    }
    const Eigen::Matrix3d inverse = normal.inverse();
    slope.block<3, 4>(LENSPROF_EMOR_MODES, kModes) = inverse * change;
    return inverse * right;
}

// Whether the profile has the response's modes.
bool put_response(const State &state, double gamma, lensprof_profile &profile, OutSlope &slope) {
    lensprof_response &response = profile.response[0];
    profile.responses = 1;
    for (lensprof_response &each : profile.response) lensprof_response_set_linear(&each);
    if (!state.camera.modes && !(state.exponent.log_gamma_sigma > 0.0)) return false;
    double table[LENSPROF_RESPONSE_SAMPLES], emor[LENSPROF_EMOR_MODES];
    raise_response(state.camera, gamma, table, emor, slope);
    if (lensprof_response_set_emor(&response, emor, LENSPROF_EMOR_MODES) == LENSPROF_OK) return true;
    if (lensprof_response_set_table(&response, table, LENSPROF_RESPONSE_SAMPLES) != LENSPROF_OK)
        lensprof_response_set_linear(&response);
    return false;
}

void put_covariance(const State &state, const Gamma &gamma, const OutSlope &slope, bool has_modes,
                    lensprof_profile &profile) {
    Eigen::Matrix<double, kOut, kGlobals> by_globals_alone =
        slope.leftCols<kGlobals>() + slope.col(kGlobals) * gamma.slope.transpose();
    const Eigen::Matrix<double, kOut, kOut> covariance =
        by_globals_alone * state.covariance * by_globals_alone.transpose()
        + gamma.variance * slope.col(kGlobals) * slope.col(kGlobals).transpose();
    const int first = has_modes ? 0 : LENSPROF_EMOR_MODES, size = kOut - first;
    std::fill(std::begin(profile.covariance), std::end(profile.covariance), 0.0);
    profile.covariance_size = static_cast<uint32_t>(size);
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++)
            profile.covariance[i * size + j] =
                0.5 * (covariance(first + i, first + j) + covariance(first + j, first + i));
}

}  // namespace

lensprof_online_exposure exposure_of(const Memory &memory, int32_t frame) {
    const State &state = memory.state();
    const Frame &record = memory.frame(frame);
    lensprof_online_exposure out;
    lensprof_online_exposure_init(&out);
    out.state = record.state, out.number = record.number, out.since = record.since, out.before = record.before;
    out.tracks = record.used, out.outliers = record.outliers, out.unusable = record.unusable;
    out.keyframe = record.keyframe;
    if (record.state == LENSPROF_ONLINE_LOST) {
        out.ev = out.step_ev = kUnknown, out.ev_sigma = out.step_sigma = std::numeric_limits<double>::infinity();
        std::fill(std::begin(out.white_balance), std::end(out.white_balance), kUnknown);
        return out;
    }
    const uint32_t green = state.channels == 3;
    const Gamma gamma = gamma_of(state.exponent);
    const double exponent = std::exp(gamma.log_gamma);
    const Exposed &e = memory.exposed(frame, green);
    const auto sigma = [&](double a, double own, const Globals &slope) {
        return std::sqrt(raised_variance(gamma, state.covariance, a, own, slope)) / kLn2;
    };
    out.ev = exponent * e.log_exposure / kLn2, out.step_ev = exponent * e.log_step / kLn2;
    out.ev_sigma = sigma(e.log_exposure, e.chain + e.own + e.tracks, e.slope);
    out.step_sigma = sigma(e.log_step, e.step, e.step_slope);
    for (uint32_t c = 0; c < 3; c++)
        out.white_balance[c] =
            state.channels == 3 ? std::exp(exponent * (memory.exposed(frame, c).log_exposure - e.log_exposure)) : 1.0;
    if (record.state == LENSPROF_ONLINE_FIRST)
        out.step_ev = kUnknown, out.step_sigma = std::numeric_limits<double>::infinity();
    return out;
}

lensprof_online_result result_of(const State &state) {
    lensprof_online_result out;
    lensprof_online_result_init(&out);
    out.frames = state.added, out.lost = state.lost, out.chains = state.chains, out.windows = state.windows;
    out.keyframes = state.kept_keyframes, out.observations = state.kept_observations;
    const Gamma gamma = gamma_of(state.exponent);
    const double exponent = std::exp(gamma.log_gamma), any = static_cast<double>(state.used + state.outliers);
    double by_mode[LENSPROF_EMOR_MODES];
    out.gamma =
        exponent * std::exp(lp_gauge_position(state.camera.table, by_mode)) / std::log(LP_GAUGE_BRIGHT / LP_GAUGE_DARK);
    out.log_gamma_sigma = std::sqrt(gamma.variance + gamma.slope.dot(state.covariance * gamma.slope));
    out.shape_sigma = std::sqrt(shape_variance(state));
    Globals slope;
    const double corner = corner_of(state.camera, slope);
    out.corner = std::exp(exponent * corner);
    out.corner_sigma = out.corner * std::sqrt(raised_variance(gamma, state.covariance, corner, 0.0, slope));
    out.falloff_sigma = exponent * std::sqrt(slope.dot(state.covariance * slope));
    out.noise_levels = 255.0 * state.noise;
    out.known_ev_scatter = gamma.scatter;
    out.inlier_share = any > 0.0 ? static_cast<double>(state.used) / any : 0.0;
    out.known = known_of(out);
    return out;
}

void put_profile(const State &state, lensprof_profile &profile) {
    const lensprof_online_result result = result_of(state);
    const Gamma gamma = gamma_of(state.exponent);
    OutSlope slope = OutSlope::Zero();
    const double exponent = std::exp(gamma.log_gamma);
    const bool has_modes = put_response(state, exponent, profile, slope);
    const Eigen::Vector3d k = raise_corner(state.camera, exponent, slope);
    profile.vignettings = 1;
    for (lensprof_vignetting &falloff : profile.vignetting) {
        std::copy_n(k.data(), 3, falloff.k);
        std::copy_n(state.camera.center, 2, falloff.center);
    }
    put_covariance(state, gamma, slope, has_modes, profile);
    lensprof_provenance &p = profile.provenance;
    std::snprintf(p.method, sizeof p.method, "online");
    std::snprintf(p.software, sizeof p.software, "lensprof %s", lensprof_version());
    p.images = static_cast<uint32_t>(std::min<uint64_t>(state.kept_keyframes, UINT32_MAX));
    p.pairs = static_cast<uint32_t>(std::min<uint64_t>(state.kept_observations, UINT32_MAX));
    p.heldout_rms = LENSPROF_UNKNOWN, p.inlier_share = state.used ? result.inlier_share : LENSPROF_UNKNOWN;
    p.gamma_sigma = result.log_gamma_sigma;
    p.not_usable = !(result.known & LENSPROF_ONLINE_KNOWS_FALLOFF);
}

}  // namespace online
}  // namespace lensprof
