// The black level of a camera, from pictures with the lens covered.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {

constexpr double mad_to_sigma =
    1.4826;  // standard deviation of normal numbers, of the median deviation from the median
constexpr double median_error = 1.2533;  // of the median of normal numbers, relative to that of their mean

struct DarkLevel {
    std::vector<std::string> files;
    std::vector<std::string> names;  // of files and pages
    std::string file;                // the first of them
    Picture form;                    // its sample type, layout and frame, without pixels
    std::array<double, 3> black{};   // samples: 0..1 of integers, or as float files have them; equal for grey pictures
    double sigma = 0.0;              // standard error of the level, from the scatter of blocks and of frames
    double spread = 0.0;             // standard deviation over the frame: what one level does not describe
    double brightest = 0.0;          // level of the brightest frame
    double reach = 0.0;              // bright sample of float frames
    std::string brightest_file;
};

// Median of the means of blocks, over all pages of all files. `channel`: of stacks with several, counted from 1; 0:
// all. Failure names a file or page that is not like the first or, if its samples are integers, not dark.
DarkLevel dark_level(const std::vector<std::string> &files, uint32_t max_side, uint32_t channel, Events &events);

// Dark frames are not pictures with light, whether they were named or lie in a folder; a note states it of named ones.
// Failure if nothing is left.
void leave_out_dark_frames(const std::vector<std::string> &dark_files, std::vector<NamedPicture> &pictures,
                           Events &events);

// What the samples of the pictures, which share their unit with dark frames, reach.
struct DarkScale {
    double brightest = 1.0;  // the sample at saturation, or a bright one
    bool is_saturation = true;
    bool has_counts = false;  // as LevelScale has
};

// The level of float frames for `picture`, which `file` holds, divided by that at saturation, if that is known. Failure
// if it is not dark on this scale, or not of the kind or the unit of the picture.
DarkLevel dark_level_for(const DarkLevel &dark, const DarkScale &scale, const Picture &picture, const std::string &file,
                         Events &events);

}  // namespace lensprof
