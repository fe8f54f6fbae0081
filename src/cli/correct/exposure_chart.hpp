// Exposure over time, before and after frames are levelled.
#pragma once

#include <string>
#include <vector>

#include "photo/deflicker/corrections.hpp"

namespace lensprof {

// The bytes of an SVG or PNG file of this name. A cut breaks the lines; frames that are not levelled are crosses at the
// lower edge.
std::string exposure_chart(const std::vector<LevelledFrame> &frames, bool has_times, const std::string &title,
                           const std::string &path);

}  // namespace lensprof
