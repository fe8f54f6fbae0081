#include "fit/online/state.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include <Eigen/LU>

#include "core/covariance.h"
#include "core/response.h"
#include "fit/online/camera.hpp"
#include "fit/online/tracks.hpp"
#include "fit/prior/falloff_prior.hpp"
#include "fit/prior/prior.hpp"

namespace lensprof {
namespace online {
namespace {

constexpr double kFirstNoise = 3.0 / 255.0;
constexpr double kLeastScatter = 0.05;   // of a mode, of its scatter over all cameras: modes that a few curves lack
constexpr double kProfileScatter = 0.2;  // the same of a profile without a covariance
constexpr int kFalloffRadii = 64;
constexpr double kMostExponent = 0.99;  // share of a variance that the error of the exponent may be
constexpr double kProfileGamma = 0.05;  // standard error of ln gamma of a profile that states none

size_t aligned(size_t bytes) { return (bytes + 15) / 16 * 16; }

uint32_t power_of_two(uint32_t least) {
    uint32_t power = 16;
    while (power < least) power *= 2;
    return power;
}

using ModeMatrix = Eigen::Matrix<double, kModes, kModes>;

struct FirstCamera {
    const double *table = nullptr;
    ModeMatrix covariance = ModeMatrix::Zero();
    double log_gamma_sigma = 0.0;
};

// The scatter of modes that are independent, as a share of that over all cameras.
void add_scatter(double share, ModeMatrix &covariance) {
    for (int l = 0; l < kModes; l++) covariance(l, l) += share * share * kEmorSigma[l] * kEmorSigma[l];
}

void take_response(const lensprof_profile &profile, FirstCamera &first) {
    first.table = profile.response[0].table;
    const auto known =
        static_cast<int>(std::min({profile.response[0].modes, profile.covariance_size, static_cast<uint32_t>(kModes)}));
    for (int l = 0; l < known; l++)
        for (int m = 0; m < known; m++)
            first.covariance(l, m) =
                profile.covariance[static_cast<uint32_t>(l) * profile.covariance_size + static_cast<uint32_t>(m)];
    add_scatter(known ? kLeastScatter : kProfileScatter, first.covariance);
    const double sigma = profile.provenance.gamma_sigma;
    first.log_gamma_sigma = sigma > 0.0 ? sigma : kProfileGamma;
}

// Change of k1..k3 by that of ln gamma, which raises M: the fit of M ln M by powers of r^2.
Eigen::Vector3d by_log_gamma(const lensprof_vignetting &falloff) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (int i = 1; i <= kFalloffRadii; i++) {
        const double r2 = static_cast<double>(i) / kFalloffRadii,
                     m = std::max(lensprof_vignetting_eval(&falloff, r2, nullptr), 1e-3);
        const Eigen::Vector3d powers(r2, r2 * r2, r2 * r2 * r2);
        normal += powers * powers.transpose(), right += m * std::log(m) * powers;
    }
    return normal.inverse() * right;
}

// The covariance at a given exponent, whose error is accounted for elsewhere.
void remove_exponent(const Eigen::Vector3d &slope, double sigma, Eigen::Matrix3d &covariance) {
    const double share = sigma * sigma * slope.dot(covariance.inverse() * slope);
    if (share > 0.0) covariance -= std::min(1.0, kMostExponent / share) * sigma * sigma * slope * slope.transpose();
}

// k1..k3 of the profile, and their covariance.
void take_falloff(const lensprof_profile &profile, double log_gamma_sigma, Knowledge &knowledge) {
    const Eigen::Map<const Eigen::Vector3d> k(profile.vignetting[0].k);
    const uint32_t n = profile.covariance_size,
                   at = lp_covariance_index(lp_covariance_modes(profile.response, profile.responses), 0);
    Eigen::Matrix3d covariance = 1e-4 * Eigen::Matrix3d::Identity();
    if (lp_falloff_variance(profile.covariance, n, at, 1.0) != LENSPROF_UNKNOWN)
        for (uint32_t i = 0; i < 3; i++)
            for (uint32_t j = 0; j < 3; j++)
                covariance(i, j) = profile.covariance[(at + i) * n + at + j] + (i == j ? 1e-8 : 0.0);
    remove_exponent(by_log_gamma(profile.vignetting[0]), log_gamma_sigma, covariance);
    const Eigen::Matrix3d precision = covariance.inverse();
    knowledge.precision.block<3, 3>(kModes, kModes) = precision;
    knowledge.weighted.segment<3>(kModes) = precision * k;
}

// That of lenses of all kinds, linear about its mean.
void expect_falloff(Knowledge &knowledge) {
    const FalloffPrior lenses = expected_falloff({});
    const double flat[3] = {0.0, 0.0, 0.0};
    Eigen::Matrix3d slope;
    log_falloff(flat, &slope);
    const Eigen::Vector3d k = slope.inverse() * (lenses.mean.array().exp() - 1.0).matrix();
    log_falloff(k.data(), &slope);
    const Eigen::Matrix3d precision = slope.transpose() * lenses.precision * slope;
    knowledge.precision.block<3, 3>(kModes, kModes) = precision;
    knowledge.weighted.segment<3>(kModes) = precision * k;
}

void take_modes(const FirstCamera &first, int modes, State &state) {
    Camera &camera = state.camera;
    camera.modes = modes;
    std::copy_n(first.table, LENSPROF_RESPONSE_SAMPLES, camera.first);
    for (int j = 0; j <= LENSPROF_RESPONSE_SAMPLES; j++)
        for (int l = 0; l < kModes; l++)
            camera.mode[j][l] =
                l < modes
                    ? static_cast<float>(lensprof_emor_table(static_cast<uint32_t>(l) + 1)[std::min(j, LP_CURVE_LAST)])
                    : 0.0f;
    ModeMatrix precision = ModeMatrix::Identity();  // of modes that are not used
    if (modes) {
        ModeMatrix covariance = ModeMatrix::Identity();
        covariance.topLeftCorner(modes, modes) = first.covariance.topLeftCorner(modes, modes);
        precision = covariance.inverse();
    }
    state.prior.precision.topLeftCorner<kModes, kModes>() = precision;
}

void begin_camera(const lensprof_online_options &options, State &state) {
    lensprof_response typical;
    double covariance[LENSPROF_EMOR_MODES * LENSPROF_EMOR_MODES];
    FirstCamera first;
    if (lensprof_response_set_typical(&typical, options.camera_kind, covariance, &first.log_gamma_sigma) != LENSPROF_OK)
        return;
    first.table = typical.table;
    for (int l = 0; l < kModes; l++)
        for (int m = 0; m < kModes; m++) first.covariance(l, m) = covariance[l * LENSPROF_EMOR_MODES + m];
    add_scatter(kLeastScatter, first.covariance);
    const bool is_linear = options.camera_kind == LENSPROF_CAMERA_LINEAR;
    std::copy_n(options.center, 2, state.camera.center);
    if (options.profile) {
        std::copy_n(options.profile->vignetting[0].center, 2, state.camera.center);
        take_falloff(*options.profile, is_linear ? 0.0 : std::max(options.profile->provenance.gamma_sigma, 0.0),
                     state.prior);
        if (!is_linear) take_response(*options.profile, first);
    } else {
        expect_falloff(state.prior);
    }
    for (int m = 0; m < kOmitted; m++) {
        const int l = static_cast<int>(options.modes) + m;
        state.omitted_sigma[m] = std::hypot(std::sqrt(std::max(covariance[l * (LENSPROF_EMOR_MODES + 1)], 0.0)),
                                            kLeastScatter * kEmorSigma[l]);
    }
    take_modes(first, is_linear ? 0 : static_cast<int>(options.modes), state);
    state.scatter = state.prior.precision;
    const GlobalMatrix spread = state.prior.precision.inverse();
    state.covariance = spread;
    set_globals(spread * state.prior.weighted, state.camera);
    double by_mode[LENSPROF_EMOR_MODES];
    state.exponent.position = lp_gauge_position(state.camera.table, by_mode);
    state.exponent.log_gamma_sigma = first.log_gamma_sigma;
}

}  // namespace

Layout layout_of(const lensprof_online_options &options) {
    Layout layout{};
    layout.live = 2 * options.tracks;
    layout.table = power_of_two(2 * (layout.live + options.tracks));
    layout.window_tracks = 4 * options.tracks;
    layout.sightings = options.tracks * options.keyframes;
    const size_t channels = options.channels;
    size_t next = aligned(sizeof(State));
    const auto place = [&next](size_t bytes) {
        const size_t at = next;
        next += aligned(bytes);
        return at;
    };
    layout.track = place(layout.live * sizeof(Track));
    layout.light = place(channels * layout.live * sizeof(Light));
    layout.slot = place(layout.table * sizeof(int32_t));
    layout.exposed = place(channels * options.history * sizeof(Exposed));
    layout.frame = place(options.history * sizeof(Frame));
    layout.sighting = place(layout.sightings * sizeof(Sighting));
    layout.window_track = place(layout.window_tracks * sizeof(WindowTrack));
    layout.window_light = place(channels * layout.window_tracks * sizeof(Light));
    layout.keyframe = place(options.keyframes * sizeof(Keyframe));
    layout.seen = place(options.tracks * sizeof(Seen));
    layout.values = place(layout.sightings * sizeof(double));
    layout.bytes = next;
    return layout;
}

void begin(const lensprof_online_options &options, State &state) {
    new (&state) State{};
    state.magic = kMagic;
    state.width = options.width, state.height = options.height, state.channels = options.channels;
    state.tracks = options.tracks, state.keyframes = options.keyframes, state.history = options.history;
    state.black = options.black, state.white = options.white;
    state.layout = layout_of(options);
    state.prior.precision.setZero(), state.prior.weighted.setZero();
    state.exponent.chain.setZero(), state.exponent.earlier.setZero();
    state.omitted.setZero(), state.moved.setZero();
    state.noise = kFirstNoise;
    state.last = state.before = kNone;
    state.is_still = 1;
    begin_camera(options, state);
    forget_all_tracks(Memory(state));
}

}  // namespace online
}  // namespace lensprof
