// `lensprof deflicker` of a video: how its frames are measured and written.
#pragma once

#include <string>
#include <vector>

#include "cli/correct/clip_output.hpp"
#include "photo/deflicker/corrections.hpp"
#include "photo/deflicker/measure.hpp"

namespace lensprof {

// Decodes the clip and measures all frames, which are named as in `output`. The response is the given one, else as of
// measure_frames: where sRGB does not fit, a dozen frames of different exposures decide, and the clip is measured
// again. Failure (not usable) for a moving camera and a single frame.
MeasuredSequence measure_clip(const std::string &clip, const MeasureOptions &options, const ClipOutput &output,
                              FrameSequence &sequence, Events &events);

// Decodes the clip again, and writes its frames levelled. One frame is held at a time.
void write_levelled_clip(const std::string &clip, const std::vector<LevelledFrame> &frames,
                         const MeasuredSequence &measured, ClipOutput &output, Events &events);

}  // namespace lensprof
