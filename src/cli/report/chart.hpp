// Relative illuminance charts (Goldman & Chen 2005, figure 5): M over r of one or several profiles, M = 1
// in the centre of the falloff, r = 1 in the corner of the frame.
#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "cli/program/library.hpp"
#include "cli/report/report.hpp"

namespace lensprof {

constexpr size_t chart_samples = 101;  // of a curve, at r = i/100
constexpr size_t chart_max_curves = 24;

struct ChartCurve {
    int64_t id;         // of the profile; 0 = of a blob
    int channel;        // 0..2; -1 = one curve for all channels
    std::string label;  // what the curve does not share with the others
    double m[chart_samples];
    double sigma[chart_samples];  // standard errors of m
    bool has_sigma;
};

struct Chart {
    std::string title;  // what the curves share
    std::string note;   // what they leave out; empty = nothing
    std::vector<ChartCurve> curves;
};

// Curves of these profiles, for those with three of one channel (0..2) or of all (-1). Failure (usage) when there are
// more than can be told apart.
Chart make_chart(const std::vector<StoredProfile> &profiles, int channel);

// The chart in characters, every curve with a letter, and the table of M, its standard error and the loss in EV.
void print_chart(const Chart &chart, std::ostream &out);

// The object of `profile show --chart --json`; docs/json.md describes it.
Json chart_json(const Chart &chart);

// Draws the chart into an SVG or PNG file, complete or not at all.
void draw_chart(const Chart &chart, const std::string &path);

// The axis of M: from `low` to `high` in `steps` steps, round numbers; 0.5 to 1 unless curves reach higher or, with
// their errors, lower, so that charts look alike.
struct ChartAxis {
    double low, high;
    int steps;

    double tick(int i) const { return low + (high - low) * i / steps; }
};
ChartAxis chart_axis(const Chart &chart);

}  // namespace lensprof
