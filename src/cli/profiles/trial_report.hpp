// Result of comparing profiles on pictures, and its text.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "cli/report/report.hpp"
#include "photo/base/library.hpp"

namespace lensprof {

struct TrialReport {
    TrialReport(const std::string &database, const std::string &pictures, const std::vector<StoredProfile> &profiles);

    std::string file, path;  // database, and the name of the pictures
    std::vector<int64_t> ids;
    std::vector<std::string> labels;
    std::vector<lensprof_trial_candidate> candidates;  // per profile, then without falloff
    lensprof_trial_result result;
};

Json trial_json(const TrialReport &report);
void print_trial(const TrialReport &report, std::ostream &out);

}  // namespace lensprof
