// Exposure over time, before and after frames are levelled.
#pragma once

#include <string>
#include <vector>

#include "photo/deflicker/corrections.hpp"

namespace lensprof {

// What the chart shows: exposures alone, or what they are before and after levelling.
enum class ChartOf {
    exposures,
    levelling
};

// The bytes of an SVG or PNG file of this name. A cut breaks the lines; frames that are not levelled are crosses at the
// lower edge.
std::string exposure_chart(const std::vector<LevelledFrame> &frames, bool has_times, const std::string &title,
                           const std::string &path, ChartOf shown = ChartOf::levelling);

}  // namespace lensprof
