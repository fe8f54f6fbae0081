// The black level of a camera, from pictures with the lens covered.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/pictures/stated_levels.hpp"

namespace lensprof {

struct DarkLevel {
    std::string file;               // the first of them
    Picture form;                   // its sample type, layout and frame, without pixels
    std::array<double, 3> black{};  // shares of full scale; those of a grey picture are equal
    double sigma = 0.0;             // standard error of the level, from the scatter of blocks and of frames
    double spread = 0.0;            // standard deviation over the frame: what one level does not describe
};

// Median of the means of blocks, over all frames. Float samples in counts are divided by the white level in `scale`;
// without (NULL), the level is in counts, too. Failure names a file that is not dark, or not like the first.
DarkLevel dark_level(const std::vector<std::string> &files, uint32_t max_side, const StatedLevels *scale,
                     Events &events);

// Failure if a picture is not of the kind of the dark frames.
void check_dark(const DarkLevel &dark, const Picture &picture, const std::string &file);

}  // namespace lensprof
