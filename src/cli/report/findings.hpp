// Findings for people.
#pragma once

#include <ostream>
#include <string>

#include "cli/report/findings.hpp"
#include "photo/report/verdict.hpp"

namespace lensprof {

// The findings as lines of a table, without the first refusal, which is the headline of a result that is not usable.
void print_findings(const Verdict &verdict, std::ostream &out);

}  // namespace lensprof
