// `lensprof calibrate` of a video, or of the frames of a moving camera.
#pragma once

#include <optional>
#include <string>

#include "cli/correct/clip_output.hpp"
#include "cli/program/run.hpp"
#include "photo/calibration/profile_store.hpp"

namespace lensprof {

struct ClipCommand {
    std::string input, output;
    std::string times;                          // file with exposure times; empty: none
    std::optional<lensprof_response> response;  // known
    std::string response_file;                  // with it; empty: none
    std::string levelled;                       // folder of levelled frames, or a video; empty: none
    std::string report;                         // a web page; empty: none
    std::string to;                             // their exposure: mean (also if empty), first, or the number of a frame
    ClipCodec codec;                            // of those
    double frames_per_s = 0.0;                  // taken of a video, or the rate of a folder; 0: all, or 25
    StoreOptions store;
    bool overwrite = false, json = false, progress = false;
};

// Whether a folder is one as of cameras for visual odometry: images/ and times.txt.
bool is_frame_folder(const std::string &path);

int calibrate_clip(const ClipCommand &o, Streams &streams);

}  // namespace lensprof
