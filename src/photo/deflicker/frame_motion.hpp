// Whether the camera of a folder of frames moves, by the shifts of what most cells of the frames show.
#pragma once

#include <lensprof/deflicker.h>

#include "photo/base/events.hpp"
#include "photo/deflicker/frames.hpp"

namespace lensprof {

// Frames that show whether the camera moves too far to be followed, and whether it moves on.
constexpr size_t refusal_frames = 12, warning_frames = 24;

// Failure (not usable) for a camera that moves too far from frame to frame.
void refuse_moving(const Frame &first, const lensprof_deflicker_result &result);

// Warns of a camera that is followed, but moves as one in a hand or a vehicle: by 0.4 % of the frame per frame on
// average, or less and irregularly. Tripods, bumps and wind do not; nor do motion-controlled cameras, which move
// slowly and evenly. `frames` were added and measured. No warning for frames that EXIF states to be half a second or
// more apart: there, only a motion-controlled camera moves so little.
void warn_of_motion(const lensprof_deflicker &deflicker, const std::vector<const Frame *> &frames, Events &events);

}  // namespace lensprof
