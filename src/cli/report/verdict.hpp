// The verdict of a fit as reported by the command: with files instead of image numbers.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <lensprof/reason.h>

namespace lensprof {

struct Verdict {
    std::string text;  // empty: usable, and no warning
    uint32_t code = LENSPROF_REASON_NONE;
    lensprof_item item{};
    std::string file;  // of the item; for a shot, its first picture
    std::vector<double> values;
};

// The verdict of a result (lensprof_fit_result or lensprof_flat_result) as the library returns it.
template <class Result>
Verdict verdict_of(const Result &result) {
    return {result.reason,
            result.reason_code,
            result.reason_item,
            {},
            {result.reason_value, result.reason_value + result.reason_values}};
}

// Replaces the number of an image by its file, if the verdict is about an image.
void name_image(const std::vector<std::string> &names, Verdict &verdict);

// Replaces the number of a shot by its first picture, if the verdict is about a shot; `shots` has the shot per picture.
void name_shot(const std::vector<std::string> &names, const std::vector<uint32_t> &shots, Verdict &verdict);

// Adds reason, reason_code, reason_item and reason_values to an object; docs/json.md describes them.
void add_verdict(const Verdict &verdict, nlohmann::ordered_json &json);

}  // namespace lensprof
