// Overlapping pictures as named on the command line, and the pairs sampled from them.
#pragma once

#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/scene/project.hpp"

namespace lensprof {

// Takes pictures and folders and finds their overlaps, or takes one project or reconstruction, whose pictures are in
// the folder `images` unless that is empty. Failure (usage) for words that are not pictures, (unreadable), and
// (not_usable) if no two pictures overlap.
Project project_of_words(const std::vector<std::string> &words, const std::string &images, Events &events);

struct DrawnPairs {
    std::vector<lensprof_pair> pairs;
    uint32_t channels = 3;  // or 1 if all pictures are grey
};

// Draws the pairs of a first fit, without knowledge of the camera.
DrawnPairs draw_pairs(const Project &project, Events &progress);

}  // namespace lensprof
