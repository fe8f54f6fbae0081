// What reader and writer of profiles as JSON share: the names of the schema (docs/json.md).
#pragma once

#include <string>

#include <lensprof/profile.h>

#include "formats/text/json_text.hpp"

namespace lensprof {

constexpr int64_t kJsonSchema = 2;  // 1 differs in what commands report of fits, not in profiles
constexpr const char *kJsonResponseKinds[] = {"linear", "gamma", "emor", "table"};
constexpr const char *kJsonProcessings[] = {"raw", "jpeg", "corrected"};

// The object of one valid profile.
void write_profile(JsonWriter &json, const lensprof_profile &profile);

}  // namespace lensprof
