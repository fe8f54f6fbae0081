// The stored range of settings of lenses and cameras.
#pragma once

#include <array>
#include <set>
#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "cli/report/report.hpp"

namespace lensprof {

// "24-70", or "50" if both ends are equal, or "-" if unknown.
std::string range_text(const double range[2]);

// [24, 70], or null; infinity as in keys.
Json range_json(const double range[2]);

// The minimum and maximum of the profiles' settings and of M in the corner; LENSPROF_UNKNOWN if none is known.
struct KnownRange {
    using Ends = std::array<double, 2>;
    static constexpr Ends none = {LENSPROF_UNKNOWN, LENSPROF_UNKNOWN};

    uint32_t profiles = 0;
    std::set<std::string> cameras, lenses, processings;
    Ends focal_mm = none, aperture = none, distance_m = none, corner = none;

    void add(const lensprof_profile &profile);
};

// docs/json.md, `range`.
Json known_range_json(const KnownRange &known);
void print_known_range(const KnownRange &known, std::ostream &out);

}  // namespace lensprof
