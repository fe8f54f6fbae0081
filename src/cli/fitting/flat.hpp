// The reports of `lensprof flat` for one lens setting.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "photo/cards/card_fit.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

// The object that `flat --json` prints; docs/json.md describes the schema.
Json flat_json(const CardFit &found);

void print_flat(const CardFit &found, bool with_notes, std::ostream &out);

// The bytes of the report as a web page.
std::string flat_page(const CardFit &found, const std::string &title, const std::string &command,
                      const std::vector<std::string> &warnings);

}  // namespace lensprof
