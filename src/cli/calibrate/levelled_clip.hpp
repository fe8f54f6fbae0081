// The levelled frames of `lensprof calibrate`: a folder, also with the poses of its cameras, or a video.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/calibrate/clip.hpp"
#include "photo/clip/clip_calibration.hpp"

namespace lensprof {

// Where they go; null: nowhere. Failure before anything is measured: for outputs that cannot be written, and (usage)
// for options that do not fit them, and for outputs that would replace one of the files `inputs`.
std::unique_ptr<ClipOutput> open_levelled(const ClipCommand &o, const std::vector<std::string> &inputs, Events &events);

// Failure (usage) for a frame in `to` that the clip does not have, or that is not measured.
void check_wanted(const ClipCommand &o, const ClipTracks &clip);

// Reads the frames of the source again and writes them, with notes of those that are not measured.
void write_levelled(const ClipCommand &o, const ClipFit &fit, const ClipTracks &clip, const FrameSource &source,
                    ClipOutput &output, Events &events);

}  // namespace lensprof
