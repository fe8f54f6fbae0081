// Reports how a profile was found or predicted, as text and as JSON.
#pragma once

#include <string>
#include <vector>

#include "photo/base/databases.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

// The answer of a lookup in these databases.
struct Found {
    lensprof_lookup lookup;
    std::vector<std::string> databases;
    bool response_is_given = false;  // by the caller: the response of the lookup is not used
};

// The same answer with a given response, without the error and notes of the lookup's response.
Found with_response_given(Found found);

// docs/json.md, `lookup`.
Json lookup_json(const Found &found);
Json reason_codes_json(const lensprof_lookup &lookup);

// "falloff predicted from 24 profiles, response typical of its kind (camera); ...": the source of the answer, and
// warnings not covered by its error. Equal for pictures with the same answer.
std::string describe_briefly(const Found &found);

// "relative illuminance in the corner +- 0.022 (falloff 0.004, distance 0.007, response 0.020)".
std::string describe_error(const lensprof_lookup &lookup);

// The three stored lenses, or cameras, whose names are nearest to one that `lookup` reports as not stored; empty for
// other answers.
std::vector<std::string> nearest_names(const Databases &databases, const lensprof_profile_key &key,
                                       const lensprof_lookup &lookup);

// "; nearest names: A; B; C", or empty.
std::string describe_nearest(const std::vector<std::string> &names);

// The answer as lines of a table.
std::string lookup_lines(const Found &found);

}  // namespace lensprof
