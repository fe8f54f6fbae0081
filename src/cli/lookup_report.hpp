/* lookup_report.hpp - how a profile was found or predicted, for people and as JSON. */
#ifndef LENSPROF_CLI_LOOKUP_REPORT_HPP
#define LENSPROF_CLI_LOOKUP_REPORT_HPP

#include <string>

#include "report.hpp"

namespace lensprof {

/* docs/json.md, `lookup`. */
Json lookup_json(const lensprof_lookup &how);

/* "predicted from 6 profiles of this lens, ..." */
std::string describe_prediction(const lensprof_lookup &how);

void print_lookup(const lensprof_lookup &how, std::ostream &out);

}  // namespace lensprof

#endif
