// What `lensprof response` found.
#pragma once

#include <string>
#include <vector>

#include "cli/report/report.hpp"

namespace lensprof {

struct ResponseFile {
    std::string file, rendered;  // rendered: the separate JPEG; empty = embedded
    lensprof_rendering_shot shot{};

    // Name of the rendered picture.
    std::string rendered_name() const { return rendered.empty() ? file + " (its preview)" : rendered; }
};

struct ResponseReport {
    std::vector<ResponseFile> files;  // empty: there was no fit
    lensprof_rendering_result result{};
    Verdict verdict;
    double load_s = 0.0, solve_s = 0.0;
    int64_t profile_id = 0;
};

Json response_report_json(const ResponseReport &report);
void print_response_report(const ResponseReport &report, std::ostream &out);

}  // namespace lensprof
