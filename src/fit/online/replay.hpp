// The chain of exposures once more, with a better camera.
//
// Exposures and radiances follow steps of the globals by their derivatives, which suffices but for the first steps,
// from a typical response to that of this camera. While the first window is there, its keyframes hold the whole chain.
#pragma once

#include "fit/online/state.hpp"

namespace lensprof {
namespace online {

// Finds exposures and radiances of all keyframes again, if they hold the whole chain. Frames between them follow their
// keyframe. Known exposures are then those of keyframes.
void replay_window(const Memory &memory);

}  // namespace online
}  // namespace lensprof
