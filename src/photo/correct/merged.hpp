// Merges the frames of a stationary camera into one HDR picture.
#pragma once

#include <string>
#include <vector>

#include "photo/correct/correction.hpp"

namespace lensprof {

// Writes the merged irradiance of all frames to `target`, as 32 bit float TIFF or OpenEXR: 1 is white at the exposure
// `wanted`, brighter irradiance is larger. Frames are weighted by how reliably they measure a pixel: noise is assumed
// equal at all grey values, so the weight is 1/f'^2 of the response times the exposure; it fades towards black and
// white and is zero if a channel is clipped. A pixel that is white in all frames gets the value of the darkest frame, a
// lower bound; a pixel that is black in all frames gets that of the brightest. Metadata are those of frame `reference`.
// Failure (usage) for frames with transparency.
void write_merged(const std::vector<Correction> &frames, size_t reference, const std::string &target, Events &events);

// Failure (usage) if the name of `target` has neither extension.
void check_merged_name(const std::string &target);

}  // namespace lensprof
