// A chart of the improvement by a correction: how much the colours of a point differ between pictures.
#pragma once

#include <string>
#include <vector>

#include "photo/calibration/scene_fit.hpp"

namespace lensprof {

// The bytes of an SVG or PNG, by the extension of `path`: for every curve, the share of pairs that differ by less than
// a number of levels of 255. Failure (usage) for other names.
std::string gain_chart(const std::string &path, const std::string &title, const std::vector<GainCurve> &curves);

}  // namespace lensprof
