// How a profile was found or predicted, for people and as JSON.
#pragma once

#include <string>
#include <vector>

#include "cli/report/report.hpp"

namespace lensprof {

// docs/json.md, `lookup`.
Json lookup_json(const lensprof_lookup &how);
Json reason_codes_json(const lensprof_lookup &how);

// "predicted from 6 profiles of this lens, ..."
std::string describe_prediction(const lensprof_lookup &how);

// "falloff predicted from ...; response ...; standard error ...", and the cautions.
std::string describe_lookup(const lensprof_lookup &how);

// The three stored lenses whose names are nearest to one that `how` says is not stored; none for any other answer.
std::vector<std::string> nearest_lenses(lensprof_store *store, const lensprof_profile_key &key,
                                        const lensprof_lookup &how);

// "; nearest names: A; B; C", or empty.
std::string describe_nearest(const std::vector<std::string> &lenses);

void print_lookup(const lensprof_lookup &how, std::ostream &out);

}  // namespace lensprof
