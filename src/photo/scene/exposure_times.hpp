// Exposures of pictures in the text file times.txt of the TUM mono dataset (Engel et al. 2016), which cameras of visual
// odometry record: one line per picture with its name, a time stamp and the exposure time; # starts a comment.
#pragma once

#include <string>
#include <vector>

#include "photo/base/events.hpp"

namespace lensprof {

// Pictures of a folder with their exposure times.
struct ExposureSweep {
    std::vector<std::string> files;
    std::string times;  // path of times.txt; empty: missing
};

// The pictures of `folder/images` or, without it, of `folder`, in alphabetical order; times.txt is in `folder` or next
// to the pictures. Failure (usage) for a folder without pictures.
ExposureSweep find_sweep(const std::string &folder, Events &events);

struct TimesLine {
    size_t number;  // in the file, from 1
    std::string name;
    double time_stamp, ev;  // ev: of the exposure time, NaN where the line states none
};

// All lines, of which there is at least one. Failure (unreadable) with the line for time stamps that do not increase,
// and exposures that are not positive numbers or that no camera has.
std::vector<TimesLine> read_times_lines(const std::string &path);

// The lines of `files`, in their order, if each of these is named, as in read_exposure_times; otherwise all lines as
// they are.
std::vector<TimesLine> lines_of_files(const std::vector<TimesLine> &lines, const std::vector<std::string> &files);

// The exposures of `files`, EV, NaN where the file states none. The exposure times may have any unit, because only
// their ratios count. Names are those of the files, with or without folder and extension. `is_whole`: the files are all
// pictures that there are, so that a line without a picture is an error. Failure as of read_times_lines, and for wrong
// names.
std::vector<double> read_exposure_times(const std::string &path, const std::vector<std::string> &files, bool is_whole,
                                        Events &events);

}  // namespace lensprof
