#include "fit/online/frame.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/mixed_bits.hpp"
#include "fit/base/quantile.hpp"
#include "fit/online/camera.hpp"
#include "fit/online/exponent.hpp"
#include "fit/online/keyframe.hpp"
#include "fit/online/tracks.hpp"

namespace lensprof {
namespace online {
namespace {

constexpr uint32_t kFewest = 5;          // tracks that determine an exposure
constexpr int kRounds = 12;              // of weights
constexpr double kExposureStill = 1e-7;  // of ln exposure, at which they end
constexpr double kFrameCutoff2 = 9.0;    // squared standard errors at which a track has half its weight
constexpr double kOutlier2 = 16.0;       // and at which it contradicts the frame
constexpr uint32_t kStrikes = 3;         // frames in a row, then the track shows something else
constexpr double kLongMemory = 60.0;     // observations that a radiance is a mean of, at most
constexpr double kNoiseShare = 0.1;      // of a frame in the running noise
constexpr double kLeastFrameNoise = 0.2 / 255.0;

// The exposure of one channel while it is found.
struct ChannelFit {
    double a = 0.0;
    double weight = 0.0;             // sum of q
    double own = 0.0, tracks = 0.0;  // variances
    double scale2 = 1.0;             // squared, of residuals in standard errors; at least 1
    uint32_t used = 0;
    Globals slope = Globals::Zero();
};

struct Residual {
    Prediction at;
    double residual = 0.0;  // grey value
    double variance = 0.0;  // of noise and radiance
    double noise = 0.0;     // of noise alone
    bool counts = false;
};

class Exposing {
public:
    Exposing(const Memory &memory, const lensprof_online_frame &frame, uint32_t channel)
        : memory_(memory), state_(memory.state()), frame_(frame), channel_(channel), lights_(memory.lights(channel)) {}

    // False if too few tracks are known.
    bool find(ChannelFit &fit) const;
    // The measured light of a track, and its derivatives, go into the track.
    void teach(const ChannelFit &fit, double &born, double &all) const;
    // Marks observations that contradict the fit.
    void mark(const ChannelFit &fit) const;

private:
    double value(uint32_t i) const { return static_cast<double>(frame_.observations[i].value[channel_]); }
    double weight(uint32_t i) const { return static_cast<double>(frame_.observations[i].weight); }
    bool is_known(uint32_t i) const {
        const Seen &seen = memory_.seen()[i];
        return seen.usable && seen.slot >= 0 && lights_[seen.slot].information > 0.0;
    }
    bool is_between(double grey) const { return grey > state_.black && grey < state_.white; }
    Residual residual(uint32_t i, double a) const;
    Globals slope_of(uint32_t i, const Prediction &at) const;
    double median_start(uint32_t &count) const;
    double round(ChannelFit &fit) const;
    void scale(ChannelFit &fit) const;
    void measure(ChannelFit &fit) const;

    const Memory &memory_;
    State &state_;
    const lensprof_online_frame &frame_;
    uint32_t channel_;
    Light *lights_;
};

Residual Exposing::residual(uint32_t i, double a) const {
    Residual r;
    const Seen &seen = memory_.seen()[i];
    const Light &light = lights_[seen.slot];
    r.at = predict(state_.camera, light.log_radiance + a + seen.log_falloff);
    r.residual = value(i) - r.at.value;
    r.noise = state_.noise * state_.noise / weight(i);
    r.variance = r.noise + r.at.by_log * r.at.by_log / light.information;
    r.counts = is_between(r.at.value) && r.at.by_log > 0.0;
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
    for (uint32_t i = 0; i < frame_.count; i++) {
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
    for (uint32_t i = 0; i < frame_.count; i++) {
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
    for (uint32_t i = 0; i < frame_.count; i++) {
        if (!is_known(i)) continue;
        const Residual r = residual(i, fit.a);
        if (r.counts) values[count++] = std::abs(r.residual) / std::sqrt(r.variance);
    }
    if (count < kFewest) return;
    const double sigma = kMadToSigma * select(values, count, count / 2) * std::sqrt(count / (count - 1.0));
    fit.scale2 = std::max(1.0, sigma * sigma);
}

// Variances and slopes of the final exposure.
void Exposing::measure(ChannelFit &fit) const {
    for (uint32_t i = 0; i < frame_.count; i++) {
        if (!is_known(i)) continue;
        const Residual r = residual(i, fit.a);
        Light &light = lights_[memory_.seen()[i].slot];
        light.share = 0.0f;
        if (!r.counts) continue;
        const double z = r.residual * r.residual / (r.variance * fit.scale2 * kFrameCutoff2);
        const double p = r.at.by_log, share = p * p / ((1.0 + z * z) * r.variance * fit.weight);
        fit.own += share * share * fit.scale2 * r.noise / (p * p);
        fit.tracks += share * share / light.information;
        fit.slope += share * (slope_of(i, r.at) - light.slope.cast<double>());
        light.share = static_cast<float>(share);
    }
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
    for (uint32_t i = 0; i < frame_.count; i++) {
        if (!is_known(i)) continue;
        const Residual r = residual(i, fit.a);
        if (!r.counts) continue;
        const double z = r.residual * r.residual / r.variance;
        if (z > kOutlier2 * fit.scale2) memory_.seen()[i].outlier = 1;
        values[count++] = std::sqrt(z * weight(i) * r.noise);
    }
    if (count < kFewest) return;
    const double noise = std::max(kMadToSigma * select(values, count, count / 2), kLeastFrameNoise);
    state_.noise += kNoiseShare / state_.channels * (noise - state_.noise);
}

void Exposing::teach(const ChannelFit &fit, double &born, double &all) const {
    for (uint32_t i = 0; i < frame_.count; i++) {
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
        light.slope += static_cast<float>(gain) * (slope.cast<float>() - light.slope);
        light.information = std::min(light.information + shown, std::max(light.information, kLongMemory * shown));
        if (is_new) born += light.information;
        all += light.information;
    }
}

void see(const Memory &memory, const lensprof_online_frame &frame) {
    State &state = memory.state();
    const lensprof_vignetting centred = {{0.0, 0.0, 0.0}, {state.camera.center[0], state.camera.center[1]}};
    for (uint32_t i = 0; i < frame.count; i++) {
        const lensprof_online_observation &o = frame.observations[i];
        Seen &seen = memory.seen()[i];
        const double r2 = lensprof_vignetting_r2(&centred, state.width, state.height, static_cast<double>(o.x),
                                                 static_cast<double>(o.y), nullptr);
        seen.r2 = static_cast<float>(r2), seen.log_falloff = log_falloff_of(state.camera, r2);
        seen.usable = o.weight > 0.0f, seen.outlier = 0;
        for (uint32_t c = 0; c < state.channels; c++) {
            const auto v = static_cast<double>(o.value[c]);
            if (!(v > state.black && v < state.white)) seen.usable = 0;
        }
        if (seen.slot < 0) seen.slot = add_track(memory, o.track);
        memory.tracks()[seen.slot].seen = state.added;
    }
}

uint32_t usable_count(const Memory &memory, uint32_t count) {
    uint32_t usable = 0;
    for (uint32_t i = 0; i < count; i++) usable += memory.seen()[i].usable;
    return usable;
}

// The exposures of all channels; false if one is not known.
bool find_exposures(const Memory &memory, const lensprof_online_frame &frame, ChannelFit *fits) {
    for (uint32_t c = 0; c < memory.state().channels; c++)
        if (!Exposing(memory, frame, c).find(fits[c])) return false;
    for (uint32_t c = 0; c < memory.state().channels; c++) Exposing(memory, frame, c).mark(fits[c]);
    return true;
}

// Tracks that contradict several frames in a row show something else from then on.
void count_outliers(const Memory &memory, uint32_t count, Frame &record) {
    State &state = memory.state();
    for (uint32_t i = 0; i < count; i++) {
        const Seen &seen = memory.seen()[i];
        if (!seen.usable) continue;
        Track &track = memory.tracks()[seen.slot];
        const bool is_known = memory.lights(0)[seen.slot].information > 0.0;
        record.outliers += seen.outlier, record.used += is_known && !seen.outlier;
        track.strikes = seen.outlier ? track.strikes + 1 : 0;
        if (track.strikes < kStrikes) continue;
        track.strikes = 0, track.window = kNone;
        for (uint32_t c = 0; c < state.channels; c++) memory.lights(c)[seen.slot] = {0.0, 0.0, 0.0f, Slope::Zero()};
    }
    state.used += record.used, state.outliers += record.outliers;
}

// The error that a chain collects by tracks that the frame lacks: what others measure no longer averages theirs out.
double lost_variance(const Memory &memory, uint32_t channel) {
    const State &state = memory.state();
    double lost = 0.0;
    for (uint32_t t = 0; t < state.live; t++) {
        Light &light = memory.lights(channel)[t];
        if (memory.tracks()[t].seen == state.added || !(light.information > 0.0)) continue;
        const auto share = static_cast<double>(light.share);
        lost += share * share / light.information;
        light.share = 0.0f;
    }
    return lost;
}

// The exposure joins the chain, and the frame teaches its tracks.
void extend_chain(const Memory &memory, const lensprof_online_frame &frame, uint32_t channel, const ChannelFit &fit) {
    State &state = memory.state();
    Exposed &now = memory.exposed(state.last, channel);
    const Exposed *before = state.before == kNone ? nullptr : &memory.exposed(state.before, channel);
    now = {fit.a, state.chain[channel], fit.own, fit.tracks, 0.0, fit.slope, Globals::Zero(), 0.0};
    double born = 0.0, all = 0.0;
    Exposing(memory, frame, channel).teach(fit, born, all);
    if (!before) return;
    now.step = fit.own + std::max(before->own, fit.tracks);
    now.step_slope = fit.slope - before->slope, now.log_step = fit.a - before->log_exposure;
    const double share = all > 0.0 ? born / all : 0.0;
    state.chain[channel] += share * share * fit.own;
}

void begin_chain(const Memory &memory, const lensprof_online_frame &frame) {
    State &state = memory.state();
    end_chain(state.exponent);
    state.chains++, state.before = kNone;
    for (uint32_t t = 0; t < state.live; t++) memory.tracks()[t].window = kNone;
    for (uint32_t c = 0; c < state.channels; c++) {
        state.chain[c] = 0.0;
        for (uint32_t t = 0; t < state.live; t++) memory.lights(c)[t] = {0.0, 0.0, 0.0f, Slope::Zero()};
    }
    for (uint32_t i = 0; i < frame.count; i++) memory.seen()[i].outlier = 0;
}

}  // namespace

Refusal find_tracks(const Memory &memory, const lensprof_online_frame &frame) {
    constexpr int32_t kFirstGuest = -2;  // places of unknown tracks hold kFirstGuest - observation while this runs
    State &state = memory.state();
    const uint32_t mask = memory.layout().table - 1;
    const uint64_t check = ++state.checks;
    int32_t *slots = memory.slots();
    Refusal refusal{Fault::none, 0};
    uint32_t found = 0;
    for (; found < frame.count && refusal.fault == Fault::none; found++) {
        const uint64_t id = frame.observations[found].track;
        auto place = static_cast<uint32_t>(mixed_bits(id)) & mask;
        const auto id_at = [&](int32_t slot) {
            return slot >= 0 ? memory.tracks()[slot].id : frame.observations[kFirstGuest - slot].track;
        };
        while (slots[place] != kNone && id_at(slots[place]) != id) place = (place + 1) & mask;
        Seen &seen = memory.seen()[found];
        seen = {};
        seen.slot = std::max(slots[place], kNone), seen.place = place;
        const bool is_repeated = seen.slot >= 0 ? memory.tracks()[seen.slot].checked == check : slots[place] != kNone;
        if (is_repeated) {
            refusal = {Fault::repeated, found};
            seen.slot = 0;  // its place is another observation's
        } else if (seen.slot >= 0) {
            memory.tracks()[seen.slot].checked = check;
        } else {
            slots[place] = kFirstGuest - static_cast<int32_t>(found);
        }
    }
    for (uint32_t i = 0; i < found; i++)
        if (memory.seen()[i].slot < 0) slots[memory.seen()[i].place] = kNone;
    return refusal;
}

void add_frame(const Memory &memory, const lensprof_online_frame &frame) {
    State &state = memory.state();
    state.last = static_cast<int32_t>(state.added++ % state.history);
    if (state.before == state.last) state.before = kNone;  // lost for as long as the history
    Frame &record = memory.frame(state.last);
    record = {frame.number, frame.number, frame.number, LENSPROF_ONLINE_LOST, 0, 0, 0, 0, 0};
    see(memory, frame);
    const uint32_t usable = usable_count(memory, frame.count);
    record.unusable = frame.count - usable;
    ChannelFit fits[3];
    for (uint32_t c = 0; c < state.channels; c++) state.chain[c] += lost_variance(memory, c);
    if (state.before != kNone && find_exposures(memory, frame, fits)) {
        record.state = LENSPROF_ONLINE_CHAINED;
        record.since = memory.frame(state.before).since, record.before = memory.frame(state.before).number;
        count_outliers(memory, frame.count, record);
    } else if (usable >= kFewest) {
        record.state = LENSPROF_ONLINE_FIRST;
        begin_chain(memory, frame);
        for (ChannelFit &fit : fits) fit = ChannelFit{};
    }
    if (record.state == LENSPROF_ONLINE_LOST) {
        state.lost++;
    } else {
        for (uint32_t c = 0; c < state.channels; c++) extend_chain(memory, frame, c, fits[c]);
        state.before = state.last;
        record.keyframe = keep_frame(memory, frame);
        if (frame.known_ev_sigma > 0.0) {
            const Exposed &measured = memory.exposed(state.last, state.channels == 3);
            add_known(frame.known_ev, frame.known_ev_sigma, measured.log_exposure, measured.slope, state.exponent);
        }
    }
    forget_tracks(memory);
}

}  // namespace online
}  // namespace lensprof
