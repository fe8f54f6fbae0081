#include "fit/online/keyframe.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {
namespace online {
namespace {

constexpr uint32_t kLongest = 30;   // frames from one keyframe to the next
constexpr double kFar = 0.08;       // mean shift of tracks since then, half diagonals
constexpr double kBrighter = 0.15;  // change of ln exposure since then
constexpr double kFewShared = 0.6;  // share of tracks that were in it

// Whether the frame shows something that the last keyframe does not.
bool is_new(const Memory &memory, const lensprof_online_frame &frame) {
    const State &state = memory.state();
    if (state.kept_keyframes == 0 || state.key_count == 0 || state.since_key >= kLongest) return true;
    const double before = memory.keyframes()[state.key_count - 1].log_exposure[0];
    if (std::abs(memory.exposed(state.last, 0).log_exposure - before) > kBrighter) return true;
    double shift = 0.0, shared = 0.0, usable = 0.0;
    for (uint32_t i = 0; i < frame.count; i++) {
        const Seen &seen = memory.seen()[i];
        if (!seen.usable || seen.outlier) continue;
        usable += 1.0;
        const Track &track = memory.tracks()[seen.slot];
        if (track.key != state.kept_keyframes) continue;
        shared += 1.0;
        const lensprof_online_observation &o = frame.observations[i];
        shift += std::hypot(static_cast<double>(o.x - track.key_xy[0]), static_cast<double>(o.y - track.key_xy[1]));
    }
    return shared < kFewShared * usable || shift > kFar * lensprof_half_diagonal(state.width, state.height) * shared;
}

// The number of a track in the window, or kNone if there is no room.
int32_t window_track_of(const Memory &memory, int32_t slot) {
    State &state = memory.state();
    Track &track = memory.tracks()[slot];
    if (track.window == kNone && state.window_count < memory.layout().window_tracks) {
        track.window = static_cast<int32_t>(state.window_count++);
        WindowTrack &of_window = memory.window_tracks()[track.window];
        of_window = {kNone, 0, {0.0, 0.0, 0.0}};
        for (uint32_t c = 0; c < state.channels; c++) of_window.log_radiance[c] = memory.lights(c)[slot].log_radiance;
    }
    return track.window;
}

void keep_observation(const Memory &memory, const lensprof_online_observation &o, const Seen &seen) {
    State &state = memory.state();
    Track &track = memory.tracks()[seen.slot];
    track.key = state.kept_keyframes;
    track.key_xy[0] = o.x, track.key_xy[1] = o.y;
    const int32_t number = window_track_of(memory, seen.slot);
    if (number == kNone) return;
    WindowTrack &of_window = memory.window_tracks()[number];
    Sighting &sighting = memory.sightings()[state.sighting_count];
    sighting = {number, of_window.last, state.key_count, seen.r2, o.weight, {o.value[0], o.value[1], o.value[2]}};
    of_window.last = static_cast<int32_t>(state.sighting_count++), of_window.count++;
}

}  // namespace

bool keep_frame(const Memory &memory, const lensprof_online_frame &frame) {
    State &state = memory.state();
    state.since_key++;
    if (state.key_count == state.keyframes || !is_new(memory, frame)) return false;
    Keyframe &key = memory.keyframes()[state.key_count];
    key.added = state.added, key.chain = state.chains, key.first = state.sighting_count;
    key.known_ev = frame.known_ev, key.known_sigma = frame.known_ev_sigma;
    for (uint32_t c = 0; c < state.channels; c++) {
        const Exposed &exposed = memory.exposed(state.last, c);
        key.log_exposure[c] = key.found[c] = exposed.log_exposure, key.found_slope[c] = exposed.slope;
    }
    state.kept_keyframes++;
    for (uint32_t i = 0; i < frame.count; i++)
        if (memory.seen()[i].usable && !memory.seen()[i].outlier)
            keep_observation(memory, frame.observations[i], memory.seen()[i]);
    key.count = state.sighting_count - key.first;
    state.kept_observations += key.count;
    state.key_count++;
    state.since_key = state.steps = 0;
    state.is_still = state.key_count < 2;
    return true;
}

void clear_window(const Memory &memory) {
    State &state = memory.state();
    state.key_count = state.window_count = state.sighting_count = 0;
    state.steps = 0, state.is_still = 1;
    for (uint32_t t = 0; t < state.live; t++) memory.tracks()[t].window = kNone;
}

}  // namespace online
}  // namespace lensprof
