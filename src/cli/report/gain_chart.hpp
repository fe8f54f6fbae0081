// What a correction gains, as a figure: how much the colours of a point differ between the pictures that see it.
#pragma once

#include <string>
#include <vector>

namespace lensprof {

struct GainCurve {
    std::string label;
    std::vector<double> variances;  // of each pair of pictures; see colour_differences. NaN is passed over
};

// The bytes of an SVG or PNG, by the end of `path`: the share of the pairs that differ by less than so many levels of
// 255, of every curve. Failure (usage) for other names.
std::string gain_chart(const std::string &path, const std::string &title, const std::vector<GainCurve> &curves);

}  // namespace lensprof
