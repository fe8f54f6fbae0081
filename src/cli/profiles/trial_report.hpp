// What a trial of profiles on pictures found, compared and in words.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "cli/profiles/profile_trial.hpp"
#include "cli/report/report.hpp"

namespace lensprof {

// Where the response of a candidate is from.
enum class ResponseOf {
    own,    // the profile
    other,  // another profile, by which it does best
    kind,   // the typical one of the kind of camera
    sensor  // linear, for the pictures are
};

// A profile, or none: no falloff.
struct Candidate {
    int64_t id = 0;  // 0 of none
    std::string label;
    ResponseOf response_from = ResponseOf::kind;
    int64_t response_id = 0;  // of another profile's
    std::vector<lensprof_response> responses;
    bool has_falloff = false;
    TrialErrors errors;

    TrialFigures figures;
    TrialDifference above_best;  // of the best profile
    TrialDifference below_none;  // by how much better it is than none
};

struct TrialReport {
    std::string file, path;  // database, and what the pictures are called
    TrialPairs pairs;
    std::vector<bool> counts;  // of the pairs that are measured
    std::vector<Candidate> profiles;
    Candidate none;
    TrialFigures before;  // the pictures as they are
    size_t best = 0;      // of the profiles

    size_t measured() const;
    size_t images() const;  // that have pairs
    bool is_as_good(const Candidate &own) const { return !own.above_best.is_clear(); }
    bool is_any_better() const;
};

// Whether a profile has any falloff: a polynomial or a gain grid.
bool has_falloff(const lensprof_profile &profile);

// Fills in what is compared, from the errors.
void compare(TrialReport &report);

Json trial_json(const TrialReport &report);
void print_trial(const TrialReport &report, std::ostream &out);

}  // namespace lensprof
