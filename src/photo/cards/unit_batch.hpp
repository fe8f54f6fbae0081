// Units of one type, compared with what they have in common: which of them pass.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "photo/cards/unit_shading.hpp"

namespace lensprof {

// The largest differences of a unit that passes.
struct UnitLimits {
    double corner = 0.03, frame = 0.05, color = 0.02;  // of the light
    double center = 0.03;                              // half diagonals
    double unseen = 0.01;                              // of the frame
};

struct Difference {
    double value = NAN, sigma = NAN;  // NAN: unknown
};

enum class UnitVerdict {
    pass,
    fail,
    not_measured,
    not_compared
};

struct UnitResult {
    size_t setting = 0;  // its number among the measured ones
    UnitVerdict verdict = UnitVerdict::not_measured;
    std::string reason;  // why it does not pass
    Difference corner;   // green, mean of the four corners; above 0: brighter
    Difference center;   // distance of its centre from the usual one, half diagonals
    Difference frame;    // the largest of any place and channel
    Difference color;    // the largest of red over green and blue over green; unknown for pictures of one curve
    double frame_at[2] = {NAN, NAN};                              // place of `frame`, shares of width and height
    double centre[2] = {NAN, NAN}, centre_sigma[2] = {NAN, NAN};  // of the unit, half diagonals
    double unseen = NAN;  // share of the frame without light that the others have, or that was left out; NAN: unknown
    std::vector<double> map;  // green at each place of the lattice, relative; empty if it was not compared
};

// The units of one setting.
struct UnitBatch {
    size_t group = 0;                        // CardSetting::group
    std::vector<UnitResult> units;           // in the order of their names
    std::shared_ptr<lensprof_profile> mean;  // of those that pass; NULL if none was measured
    Lattice lattice{usual_aspect, 0, 0, false};
    Shading usual;           // what they are compared with; empty if they are not
    std::string note;        // on the batch as a whole
    int64_t profile_id = 0;  // of the mean; 0 = not stored

    size_t count(UnitVerdict verdict) const;
};

// `reference`: what to compare with, instead of the median of the units; NULL: none.
std::vector<UnitBatch> compare_units(const std::vector<MeasuredSetting> &settings, const UnitLimits &limits,
                                     const lensprof_profile *reference);

}  // namespace lensprof
