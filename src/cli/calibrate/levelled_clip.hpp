// The levelled frames of `lensprof calibrate`: a folder, also with the poses of its cameras, or a video.
#pragma once

#include <memory>

#include "cli/calibrate/clip.hpp"
#include "photo/clip/clip_calibration.hpp"

namespace lensprof {

// Where they go; null: nowhere. Failure before anything is measured: for outputs that cannot be written, and (usage)
// for options that do not fit them.
std::unique_ptr<ClipOutput> open_levelled(const ClipCommand &o, Events &events);

// Failure (usage) for a frame in `to` that the clip does not have, or that is not measured.
void check_wanted(const ClipCommand &o, const ClipTracks &clip);

// Writes them, with notes of those that are not measured. `rate`: frames per second of a folder.
void write_levelled(const ClipCommand &o, const ClipFit &fit, const ClipTracks &clip, double rate, ClipOutput &output,
                    Events &events);

}  // namespace lensprof
