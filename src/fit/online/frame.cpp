#include "fit/online/frame.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/mixed_bits.hpp"
#include "fit/online/camera.hpp"
#include "fit/online/exponent.hpp"
#include "fit/online/exposing.hpp"
#include "fit/online/keyframe.hpp"
#include "fit/online/tracks.hpp"

namespace lensprof {
namespace online {
namespace {

constexpr uint32_t kStrikes = 3;  // frames in a row, then the track shows something else

Exposing exposing(const Memory &memory, uint32_t count, uint32_t channel) {
    return Exposing(memory, count, channel, memory.lights(channel));
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
        seen.usable = o.weight > 0.0f, seen.outlier = 0, seen.weight = o.weight;
        std::copy_n(o.value, 3, seen.value);
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
        if (!exposing(memory, frame.count, c).find(fits[c])) return false;
    for (uint32_t c = 0; c < memory.state().channels; c++) exposing(memory, frame.count, c).mark(fits[c]);
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
        for (uint32_t c = 0; c < state.channels; c++) memory.lights(c)[seen.slot] = {0.0, 0.0, Slope::Zero()};
    }
    state.used += record.used, state.outliers += record.outliers;
}

// The exposure joins the chain, and the frame teaches its tracks.
void extend_chain(const Memory &memory, const lensprof_online_frame &frame, uint32_t channel, const ChannelFit &fit) {
    State &state = memory.state();
    Exposed &now = memory.exposed(state.last, channel);
    const Exposed *before = state.before == kNone ? nullptr : &memory.exposed(state.before, channel);
    now = {fit.a, state.chain[channel], fit.own, fit.tracks, 0.0, fit.slope, Globals::Zero(), 0.0};
    exposing(memory, frame.count, channel).teach(fit);
    if (!before) return;
    now.step = fit.own + std::max(before->own, fit.tracks);
    now.step_slope = fit.slope - before->slope, now.log_step = fit.a - before->log_exposure;
    state.chain[channel] += fit.drift;
}

void begin_chain(const Memory &memory, const lensprof_online_frame &frame) {
    State &state = memory.state();
    end_chain(state.exponent);
    state.chains++, state.before = kNone;
    for (uint32_t t = 0; t < state.live; t++) memory.tracks()[t].window = kNone;
    for (uint32_t c = 0; c < state.channels; c++) {
        state.chain[c] = 0.0;
        for (uint32_t t = 0; t < state.live; t++) memory.lights(c)[t] = {0.0, 0.0, Slope::Zero()};
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
            add_known(frame.known_ev, frame.known_ev_sigma, measured, state.exponent);
        }
    }
    forget_tracks(memory);
}

}  // namespace online
}  // namespace lensprof
