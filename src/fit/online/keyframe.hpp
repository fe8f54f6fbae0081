// Which frames are kept, and their observations in the window.
#pragma once

#include "fit/online/state.hpp"

namespace lensprof {
namespace online {

// Keeps the last frame as a keyframe if it differs enough from the keyframe before, and the window has room. Returns
// whether it did.
bool keep_frame(const Memory &memory, const lensprof_online_frame &frame);

// Drops all keyframes and their observations.
void clear_window(const Memory &memory);

}  // namespace online
}  // namespace lensprof
