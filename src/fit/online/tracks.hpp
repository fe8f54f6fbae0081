// The tracks of the last frames, and the table that finds them by their id.
#pragma once

#include "fit/online/state.hpp"

namespace lensprof {
namespace online {

// Forgets tracks that were not seen for some frames, and all that the last frame lacks if the next one could need room.
void forget_tracks(const Memory &memory);

// Forgets all.
void forget_all_tracks(const Memory &memory);

// Adds a track.
int32_t add_track(const Memory &memory, uint64_t id);

// The place of an id in slots(): that of its track, or the free one where it would be.
uint32_t place_of(const Memory &memory, uint64_t id);

}  // namespace online
}  // namespace lensprof
