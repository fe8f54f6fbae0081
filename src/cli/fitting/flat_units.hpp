// The run of `lensprof flat --units`.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/unit_report.hpp"
#include "cli/program/progress.hpp"

namespace lensprof {

struct UnitsCommand {
    const CardOptions &cards;
    const UnitOptions &units;
    std::vector<std::string> outputs;  // .csv
    std::string report;                // empty: none
    bool json, progress;
};

// For options and outputs that were checked. Returns the exit code.
int run_units(const UnitsCommand &o, const CardSettings &settings, Streams &streams);

}  // namespace lensprof
