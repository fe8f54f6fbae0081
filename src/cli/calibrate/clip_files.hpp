// What `lensprof calibrate` writes of a clip.
#pragma once

#include <string>
#include <vector>

#include "photo/base/output_file.hpp"
#include "photo/clip/clip_calibration.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

// The names of the files that it writes into the folder.
std::vector<std::string> clip_files(const std::string &folder);

// Whether an earlier run wrote the files of the folder, by the first line of its exposures.csv.
bool has_clip_files(const std::string &folder);

// Exposure times of frames, from a file of lines "name time_stamp exposure" as of the TUM mono dataset: EV per frame,
// NaN where the line states none. There is a line for each frame of the clip or, of a part of the frames, for each of
// those. Failure (unreadable) with the line.
std::vector<double> read_clip_times(const std::string &path, const ClipTracks &clip);

// The EV that is added to an exposure of the clip to get log2 of the known exposure time; 0 if none is known.
double offset_of_times(const ClipTracks &clip, const std::vector<double> &known_ev);

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
