// Result of comparing profiles on pictures, and its text.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "cli/profiles/profile_trial.hpp"
#include "cli/report/report.hpp"

namespace lensprof {

// Source of a candidate's response.
enum class ResponseOf {
    own,    // the profile itself
    other,  // another profile, whose response fits best
    kind,   // the typical response of the kind of camera
    sensor  // linear, because the pictures are
};

// A profile, or no falloff correction.
struct Candidate {
    int64_t id = 0;  // 0 for no falloff correction
    std::string label;
    ResponseOf response_from = ResponseOf::kind;
    int64_t response_id = 0;  // of the other profile whose response is used
    std::vector<lensprof_response> responses;
    bool has_falloff = false;
    TrialErrors errors;

    TrialFigures figures;
    TrialDifference excess_over_best;  // of the best profile
    TrialDifference gain_over_none;    // improvement over no falloff correction
};

struct TrialReport {
    std::string file, path;  // database, and the name of the pictures
    TrialPairs pairs;
    std::vector<bool> is_explained;  // of the measured pairs
    std::vector<Candidate> profiles;
    Candidate none;
    TrialFigures before;  // the pictures as they are
    size_t best = 0;      // of the profiles

    size_t measured() const;
    size_t images() const;  // with pairs
    bool is_as_good(const Candidate &candidate) const { return !candidate.excess_over_best.is_clear(); }
    bool is_any_better() const;
};

// Whether a profile has any falloff: a polynomial or a gain grid.
bool has_falloff(const lensprof_profile &profile);

// Computes the comparison from the residuals.
void compare(TrialReport &report);

Json trial_json(const TrialReport &report);
void print_trial(const TrialReport &report, std::ostream &out);

}  // namespace lensprof
