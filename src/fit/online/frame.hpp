// The exposure of one frame from the tracks that it shares with earlier ones, and what the frame adds to the tracks.
#pragma once

#include "fit/online/state.hpp"

namespace lensprof {
namespace online {

// How a frame is refused, with the observation at fault; nothing is changed.
enum class Fault {
    none,
    repeated
};
struct Refusal {
    Fault fault;
    uint32_t observation;
};

// Finds the tracks of all observations: fills seen().
Refusal find_tracks(const Memory &memory, const lensprof_online_frame &frame);

// Adds the frame, whose tracks were found, as memory.state().last.
void add_frame(const Memory &memory, const lensprof_online_frame &frame);

}  // namespace online
}  // namespace lensprof
