// What reader and writer of profiles as JSON share: the names of the schema (docs/json.md).
#pragma once

#include <string>

#include <lensprof/profile.h>

#include "formats/text/json_text.hpp"

namespace lensprof {

constexpr int64_t kJsonSchema = 2;  // 1 differs in what commands report of fits, not in profiles
constexpr const char *kJsonResponseKinds[] = {"linear", "gamma", "emor", "table"};
constexpr const char *kJsonProcessings[] = {"raw", "jpeg", "corrected"};

// A curve of the kind that `object` names, with the samples that there are.
void read_curve(const JsonValue &object, const JsonValue &samples, lensprof_response &response);

// One or three falloffs; returns their number.
uint32_t read_vignetting(const JsonValue &object, lensprof_vignetting (&vignetting)[3]);

// A member with a text, or with a number that is null if it is unknown.
void write_text(JsonWriter &json, const char *name, const char *value);
void write_known(JsonWriter &json, const char *name, double value);

// `kind`, and the numbers that make the curve if it is not a table.
void write_kind(JsonWriter &json, const lensprof_response &response);

// Whether these give the samples of the curve to the last bit, which those of a blob are rounded from.
bool is_implied(const lensprof_response &response);

// The member `vignetting`.
void write_vignetting(JsonWriter &json, const lensprof_vignetting *vignetting, uint32_t count);

// The object of one valid profile.
void write_profile(JsonWriter &json, const lensprof_profile &profile);

}  // namespace lensprof
