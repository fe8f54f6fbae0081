// Frames of a camera that stood still -> one picture of the light in all of them.
#pragma once

#include <string>
#include <vector>

#include "cli/correct/correction.hpp"

namespace lensprof {

// Writes the light of all frames, as 32 bit float TIFF or OpenEXR, to `target`: 1 is white of a picture of the exposure
// `wanted` of the frames, brighter light is more. Every frame counts by how well it shows the light of a pixel: its
// noise is the same at all grey values, so that 1/f'^2 of the response and its exposure weigh it; a pixel with a
// channel next to black or white counts less and less, and not at all where it is that. What all frames have white is
// as bright as the darkest of them says, or brighter; what all have black is from the brightest. Metadata are those of
// frame `like`. Failure (usage) for frames with transparency.
void write_merged(const std::vector<Correction> &frames, size_t like, const std::string &target, Progress &progress);

// Failure (usage) where `target` is neither by its name.
void check_merged_name(const std::string &target);

}  // namespace lensprof
