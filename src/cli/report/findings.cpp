#include "cli/report/findings.hpp"

#include "photo/base/format.hpp"

namespace lensprof {

void print_findings(const Verdict &verdict, std::ostream &out) {
    for (const Finding &finding : verdict.findings)
        if (finding.severity != LENSPROF_SEVERITY_REFUSAL || &finding != &verdict.findings[0])
            out << format("%-8s  ", severity_name(finding.severity)) << with_code(finding) << "\n";
}

}  // namespace lensprof
