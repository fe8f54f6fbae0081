// Judges whether the result is the response of a camera.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "cli/response/rules.hpp"

namespace lensprof {
namespace response_measure {

double tenths(const ResponseReport &report) { return report.tenths; }

double noise(const ResponseReport &report) {
    double worst = 0.0;
    for (const FileFindings &file : report.files) worst = std::max(worst, file.noise_levels);
    return worst;
}

double map(const ResponseReport &report) { return most_patterned(report).pattern_levels; }

double gamma_sigma(const ResponseReport &report) { return report.log_gamma_sigma; }

// At the end where more are missing; the bright end is 256.
double missing_levels(const ResponseReport &report) { return std::max(report.lowest, 256.0 - report.highest); }

std::vector<double> of_map(const ResponseReport &report) {
    return {most_patterned(report).pattern_ev, most_patterned(report).pattern_levels};
}

std::vector<double> range(const ResponseReport &report) { return {report.lowest / 255.0, report.highest / 255.0}; }

std::string patterned_file(const ResponseReport &report) {
    return report.files.size() > 1 ? most_patterned(report).file + ": " : "";
}

}  // namespace response_measure

const FileFindings &most_patterned(const ResponseReport &report) {
    return *std::max_element(report.files.begin(), report.files.end(),
                             [](const auto &a, const auto &b) { return a.pattern_levels < b.pattern_levels; });
}

void judge(ResponseReport &report) {
    for (const ResponseRule &rule : kResponseRules) {
        if (report.verdict.find(rule.code)) continue;  // of two severities, the first counts
        const double measured = rule.measure(report);
        const bool is_found = rule.is_above ? measured > rule.limit : measured < rule.limit;
        Finding finding{rule.code, rule.severity, is_found ? rule.text(report) : ""};
        finding.measured = measured, finding.limit = rule.limit;
        if (is_found) finding.values = rule.values(report);
        if (is_found)
            report.verdict.add_last(finding);
        else
            report.verdict.passed.push_back(finding);
    }
    report.usable = report.verdict.texts(LENSPROF_SEVERITY_REFUSAL).empty();
}

}  // namespace lensprof
