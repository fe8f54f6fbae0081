#include "fit/online/tracks.hpp"

#include <algorithm>

#include "fit/base/mixed_bits.hpp"

namespace lensprof {
namespace online {
namespace {

constexpr uint64_t kPatience = 15;  // frames that a track may be hidden

void fill_slots(const Memory &memory) {
    std::fill_n(memory.slots(), memory.layout().table, kNone);
    for (uint32_t t = 0; t < memory.state().live; t++)
        memory.slots()[place_of(memory, memory.tracks()[t].id)] = static_cast<int32_t>(t);
}

void move_track(const Memory &memory, uint32_t from, uint32_t to) {
    if (from == to) return;
    memory.tracks()[to] = memory.tracks()[from];
    for (uint32_t c = 0; c < memory.state().channels; c++) memory.lights(c)[to] = memory.lights(c)[from];
}

}  // namespace

uint32_t place_of(const Memory &memory, uint64_t id) {
    const uint32_t mask = memory.layout().table - 1;
    const int32_t *slots = memory.slots();
    auto place = static_cast<uint32_t>(mixed_bits(id)) & mask;
    while (slots[place] >= 0 && memory.tracks()[slots[place]].id != id) place = (place + 1) & mask;
    return place;
}

void forget_tracks(const Memory &memory) {
    State &state = memory.state();
    const bool is_full = state.live > state.tracks;
    uint32_t kept = 0;
    for (uint32_t t = 0; t < state.live; t++) {
        const uint64_t hidden = state.added - memory.tracks()[t].seen;
        if (hidden > kPatience || (is_full && hidden > 0)) continue;
        move_track(memory, t, kept++);
    }
    state.live = kept;
    fill_slots(memory);
}

void forget_all_tracks(const Memory &memory) {
    memory.state().live = 0;
    fill_slots(memory);
}

int32_t add_track(const Memory &memory, uint64_t id) {
    const uint32_t track = memory.state().live++;
    memory.tracks()[track] = {id, 0, {0.0f, 0.0f}, 0, kNone, 0, 0};
    for (uint32_t c = 0; c < memory.state().channels; c++) memory.lights(c)[track] = {0.0, 0.0, Slope::Zero()};
    memory.slots()[place_of(memory, id)] = static_cast<int32_t>(track);
    return static_cast<int32_t>(track);
}

}  // namespace online
}  // namespace lensprof
