// Relative illuminance charts (Goldman & Chen 2005, figure 5): M over r of one or several profiles, M = 1
// in the centre of the falloff, r = 1 in the corner of the frame.
#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "cli/report/report.hpp"
#include "photo/base/library.hpp"

namespace lensprof {

constexpr const char *channel_names[3] = {"red", "green", "blue"};

constexpr size_t chart_samples = 101;  // of a curve, at r = i/100
constexpr size_t chart_max_curves = 24;

struct ChartCurve {
    int64_t id;         // id of the profile; 0 = from a blob
    int channel;        // 0..2; -1 = one curve for all channels
    std::string label;  // what distinguishes the curve from the others
    double m[chart_samples];
    double sigma[chart_samples];  // standard errors of m
    bool has_sigma;
};

struct Chart {
    std::string title;  // what the curves share
    std::string note;   // what they omit; empty = nothing
    std::vector<ChartCurve> curves;
};

// Curves of these profiles; for profiles with three curves that of one channel (0..2) or all (-1). Failure (usage) for
// more curves than can be distinguished.
Chart make_chart(const std::vector<StoredProfile> &profiles, int channel);

// The chart as text, with a letter per curve, and the table of M, its standard error and the loss in EV.
void print_chart(const Chart &chart, std::ostream &out);

// The object of `profile show --chart --json`; docs/json.md describes it.
Json chart_json(const Chart &chart);

// Writes the chart as an SVG or PNG file, completely or not at all.
void draw_chart(const Chart &chart, const std::string &path);

// The axis of M: from `low` to `high` in `steps` steps, round numbers; 0.5 to 1 unless curves exceed it or, with their
// errors, fall below it, so that charts are comparable.
struct ChartAxis {
    double low, high;
    int steps;

    double tick(int i) const { return low + (high - low) * i / steps; }
};
ChartAxis chart_axis(const Chart &chart);

}  // namespace lensprof
