// `lensprof deflicker` of a video: levelled frames as PNG.
#pragma once

#include <string>

#include "cli/program/run.hpp"
#include "photo/deflicker/measure.hpp"

namespace lensprof {

struct DeflickerClip {
    std::string clip, folder;
    std::string to;     // smooth (also if empty), mean or first
    std::string chart;  // file; empty: none
    double window_s = 0.0;
    const MeasureOptions &measure;  // response (else sRGB), region and rows
    bool json = false, progress = false;
};

// Decodes the clip twice: to measure all frames, and to write them as frame_00001.png and so on, with exposures.csv.
// One frame is held at a time.
int deflicker_clip(const DeflickerClip &o, Streams &streams);

}  // namespace lensprof
