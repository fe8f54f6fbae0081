// What `lensprof calibrate` writes of a clip.
#pragma once

#include <string>
#include <vector>

#include "photo/base/output_file.hpp"
#include "photo/clip/clip_calibration.hpp"
#include "photo/clip/frame_source.hpp"
#include "photo/report/report.hpp"
#include "photo/scene/exposure_times.hpp"

namespace lensprof {

// The names of the files that it writes into the folder.
std::vector<std::string> clip_files(const std::string &folder);

// Whether an earlier run wrote the files of the folder, by the first line of its exposures.csv.
bool has_clip_files(const std::string &folder);

// Exposure times of the frames of a clip, from a file of lines "name time_stamp exposure" as of the TUM mono dataset.
class GivenTimes {
public:
    // Reads the file; an empty path has no lines. Failure (unreadable) with the line, and for a number of lines that is
    // not that of the frames. There is a line for each frame of the clip or, of a part of the frames, for each of
    // those. Lines that name the pictures of a folder are theirs, others are in the order of the frames.
    GivenTimes(const std::string &path, const FrameSource &source, bool uses_all_frames);

    // EV per frame, NaN where its line states none; empty: none is known.
    std::vector<double> of(const ClipTracks &clip) const;

    // The same while frames are still being read; empty for a part of the frames.
    std::vector<double> of_first(const ClipTracks &clip) const;

    // By how much the known exposures differ, EV; 0: none is known.
    double range_ev() const;

private:
    void check_time_stamps(const ClipTracks &clip) const;
    [[noreturn]] void fail_count(uint64_t frames) const;

    std::string path_;
    std::vector<TimesLine> lines_;
    bool uses_all_frames_;
};

// pcalib.txt and vignette.png (16 bit, of the frame's size), which DSO and its kin read. Returns their names.
std::vector<std::string> write_model(const ClipFit &fit, const ClipTracks &clip, const std::string &folder,
                                     OutputFiles &outputs);

// times.txt, exposures.csv, exposures.json and exposures.svg.
std::vector<std::string> write_exposures(const ClipTracks &clip, double offset_ev, const std::string &folder,
                                         OutputFiles &outputs);

// The frames as exposures.json and --json list them.
Json clip_frames_json(const ClipTracks &clip);

const char *clip_state_name(ClipState state);

}  // namespace lensprof
