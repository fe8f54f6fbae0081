// The verdict of a fit as the command gives it: files in place of the numbers of images.
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
    std::string file;  // of the item; of a shot that of its first picture
    std::vector<double> values;
};

// The verdict of a result, lensprof_fit_result or lensprof_flat_result, as the library gives it.
template <class Result>
Verdict verdict_of(const Result &result) {
    return {result.reason,
            result.reason_code,
            result.reason_item,
            {},
            {result.reason_value, result.reason_value + result.reason_values}};
}

// Names the file of an image in place of its number, where the verdict is about one.
void name_image(const std::vector<std::string> &names, Verdict &verdict);

// Names the first picture of a shot in place of its number, where the verdict is about one; `shots` are those of the
// pictures.
void name_shot(const std::vector<std::string> &names, const std::vector<uint32_t> &shots, Verdict &verdict);

// Adds reason, reason_code, reason_item and reason_values to an object; docs/json.md describes them.
void add_verdict(const Verdict &verdict, nlohmann::ordered_json &json);

}  // namespace lensprof
