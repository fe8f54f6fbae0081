// The frames of a sequence, in order.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/pictures/metadata.hpp"

namespace lensprof {

struct Frame {
    std::string file;
    PictureMetadata metadata;
    double seconds = NAN;      // since the first frame; NaN: not known of all
    double settings_ev = NAN;  // by EXIF; NaN: not known of all
};

struct LeftOutFrame {
    std::string file, reason;  // a complete message
};

struct FrameSequence {
    std::vector<Frame> frames;
    std::vector<LeftOutFrame> left_out;
    bool is_by_time = false;  // in order of the times in EXIF, not of the names

    bool has_exposure_steps() const;  // EXIF states different exposures
};

// The frames named, and those in folders named, in order of their times in EXIF, or of their names (numbers in names by
// value) where a time is missing. Frames that cannot be read or have another size or orientation than most are left
// out. Failure (usage) for a file given twice, for frames in several subfolders and for videos; Failure (not usable)
// for fewer than two frames.
FrameSequence list_frames(const std::vector<std::string> &names, const std::string &output, Events &events);

// Whether a name comes before another, digits by value: "f9" before "f10".
bool comes_before(const std::string &a, const std::string &b);

}  // namespace lensprof
