// Overlapping pictures as a user names them, and the pairs that are drawn of them.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/project.hpp"
#include "cli/program/run.hpp"

namespace lensprof {

// Pictures and folders, whose overlaps are found, or one project or reconstruction, whose pictures are in the folder
// `images` where that is not empty. Failure: usage for words that are no pictures among others, unreadable, and not
// usable where no two overlap.
Project project_of_words(const std::vector<std::string> &words, const std::string &images, Progress &progress,
                         Streams &streams);

struct DrawnPairs {
    std::vector<lensprof_pair> pairs;
    uint32_t channels = 3;  // or 1 where all pictures are grey
};

// What the first look of a fit draws; nothing is known of the camera.
DrawnPairs draw_pairs(const Project &project, Progress &progress);

}  // namespace lensprof
