#include "fit/online/replay.hpp"

#include <algorithm>
#include <cmath>

#include "fit/online/camera.hpp"
#include "fit/online/exponent.hpp"
#include "fit/online/exposing.hpp"

namespace lensprof {
namespace online {
namespace {

constexpr uint64_t kMostSince = 30;  // frames since the last keyframe that its correction holds for

struct Again {
    double a[3];
    Globals slope[3];
};

bool holds_chain(const Memory &memory) {
    const State &state = memory.state();
    for (uint32_t k = 0; k < state.key_count; k++)
        if (memory.keyframes()[k].chain != 1) return false;
    return state.chains == 1 && memory.keyframes()[0].added == 1;
}

void see_again(const Memory &memory, const Keyframe &key) {
    for (uint32_t i = 0; i < key.count; i++) {
        const Sighting &sighting = memory.sightings()[key.first + i];
        Seen &seen = memory.seen()[i];
        seen = {};
        seen.slot = sighting.track, seen.usable = 1, seen.r2 = sighting.r2, seen.weight = sighting.weight;
        seen.log_falloff = log_falloff_of(memory.state().camera, static_cast<double>(seen.r2));
        std::copy_n(sighting.value, 3, seen.value);
    }
}

// Exposes a keyframe; false if its tracks are too few.
bool expose_again(const Memory &memory, uint32_t k, Again &again) {
    const Keyframe &key = memory.keyframes()[k];
    see_again(memory, key);
    for (uint32_t c = 0; c < memory.state().channels; c++) {
        const Exposing exposing(memory, key.count, c, memory.window_lights(c));
        ChannelFit fit;
        if (k > 0 && !exposing.find(fit)) return false;
        exposing.teach(fit);
        again.a[c] = fit.a, again.slope[c] = fit.slope;
    }
    return true;
}

// The frames of the history move with the last keyframe before them.
void correct_frames(const Memory &memory, const Again *again) {
    State &state = memory.state();
    int32_t before = kNone;
    uint32_t k = 0;
    for (uint64_t n = state.added - std::min<uint64_t>(state.added, state.history) + 1; n <= state.added; n++) {
        const auto frame = static_cast<int32_t>((n - 1) % state.history);
        if (memory.frame(frame).state == LENSPROF_ONLINE_LOST) continue;
        while (k + 1 < state.key_count && memory.keyframes()[k + 1].added <= n) k++;
        const Keyframe &key = memory.keyframes()[k];
        for (uint32_t c = 0; c < state.channels; c++) {
            Exposed &exposed = memory.exposed(frame, c);
            exposed.log_exposure += again[k].a[c] - key.found[c];
            exposed.slope += again[k].slope[c] - key.found_slope[c];
            if (before == kNone) continue;
            exposed.log_step = exposed.log_exposure - memory.exposed(before, c).log_exposure;
            exposed.step_slope = exposed.slope - memory.exposed(before, c).slope;
        }
        before = frame;
    }
}

// Radiances by the window; those of tracks beyond it follow the exposures of the frames that show them.
void teach_tracks(const Memory &memory, const Again &last) {
    State &state = memory.state();
    const Keyframe &key = memory.keyframes()[state.key_count - 1];
    for (uint32_t c = 0; c < state.channels; c++)
        for (uint32_t t = 0; t < state.live; t++) {
            Light &light = memory.lights(c)[t];
            const int32_t window = memory.tracks()[t].window;
            if (window == kNone) {
                if (light.information > 0.0) {
                    light.log_radiance -= last.a[c] - key.found[c];
                    light.slope -= (last.slope[c] - key.found_slope[c]).cast<float>();
                }
                continue;
            }
            light = memory.window_lights(c)[window];
        }
}

}  // namespace

void replay_window(const Memory &memory) {
    State &state = memory.state();
    state.has_moved = 0;
    const uint64_t since = state.added - memory.keyframes()[state.key_count - 1].added;
    if (!holds_chain(memory) || since > kMostSince) return;
    for (uint32_t c = 0; c < state.channels; c++)
        std::fill_n(memory.window_lights(c), state.window_count, Light{0.0, 0.0, Slope::Zero()});
    Again again[kMostKeyframes];
    for (uint32_t k = 0; k < state.key_count; k++)
        if (!expose_again(memory, k, again[k])) return;
    correct_frames(memory, again);
    teach_tracks(memory, again[state.key_count - 1]);
    state.exponent.chain.setZero(), state.exponent.earlier.setZero();
    state.exponent.known = state.exponent.chains = state.exponent.noise = 0.0, state.exponent.chain_count = 0;
    for (uint32_t k = 0; k < state.key_count; k++) {
        Keyframe &key = memory.keyframes()[k];
        for (uint32_t c = 0; c < state.channels; c++) {
            key.found[c] = key.log_exposure[c] = again[k].a[c], key.found_slope[c] = again[k].slope[c];
        }
        if (key.known_sigma > 0.0) {
            const uint32_t c = state.channels == 3;
            const Exposed measured = {again[k].a[c], 0.0, 0.0, 0.0, 0.0, again[k].slope[c], Globals::Zero(), 0.0};
            add_known(key.known_ev, key.known_sigma, measured, state.exponent);
        }
    }
}

}  // namespace online
}  // namespace lensprof
