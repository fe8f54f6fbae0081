// Reports of a fit or profile as tables.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "photo/report/falloff.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

void print_build(const BuildReport &report, std::ostream &out);

// The truth of a simulated sequence: exposures and (green) falloff.
struct TrueValues {
    std::vector<double> ev;
    lensprof_vignetting vignetting{};
};

// Reads the truth.json of `simulate`; Failure (unreadable) for another file or number of images.
TrueValues read_truth(const std::string &path, size_t images);

// Prints recovered next to true values, raw and with the exponent gamma aligned (which pictures alone do not
// determine).
void print_comparison(const BuildReport &report, const TrueValues &truth, std::ostream &out);

// Parts of tables. `aspect`: width over height of the frame.
void print_vignettings(const lensprof_profile &profile, std::ostream &out, double aspect = usual_aspect);
void print_response(const lensprof_response &r, std::ostream &out);
void print_levels(const lensprof_levels &levels, std::ostream &out);  // nothing without any

void print_profile(int64_t id, const lensprof_profile &profile, std::ostream &out);

}  // namespace lensprof
