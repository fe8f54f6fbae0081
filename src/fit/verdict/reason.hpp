// The verdict as data, and the sentence made from it.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <lensprof/fit.h>

#include "fit/verdict/result.hpp"

namespace lensprof {

// The content of a verdict.
struct Reason {
    lensprof_reason code;
    std::vector<double> values;  // the values that reason.h lists for the code
    lensprof_item_kind kind = LENSPROF_ITEM_NONE;
    uint32_t index = 0;
};

// Makes a reason about an image or a shot.
Reason of_image(lensprof_reason code, uint32_t index, std::vector<double> values = {});
Reason of_shot(lensprof_reason code, uint32_t number, std::vector<double> values = {});

// A reason in words, and the position of the image or shot in them.
struct Sentence {
    std::string text;
    lensprof_item item;
};
Sentence sentence_of(const Reason &reason);

// Stores a reason in a result, of an overlap fit or a flat field. Returns true.
template <class Result>
bool give_reason(Result &r, const Reason &reason, bool usable) {
    const Sentence sentence = sentence_of(reason);
    r.usable = usable;
    std::snprintf(r.reason, sizeof r.reason, "%s", sentence.text.c_str());
    r.reason_code = reason.code;
    r.reason_item = sentence.item;
    r.reason_values = static_cast<uint32_t>(reason.values.size());
    std::fill(r.reason_value, r.reason_value + 2, 0.0);
    std::copy(reason.values.begin(), reason.values.end(), r.reason_value);
    return true;
}

template <class Result>
bool refuse(Result &r, const Reason &reason) {
    return give_reason(r, reason, false);
}

template <class Result>
bool warn(Result &r, const Reason &reason) {
    return give_reason(r, reason, true);
}

// Whether a warning is about grey values that were seen; it has lower priority than one about images that do not
// connect.
inline bool is_of_greys(uint32_t reason) {
    return reason == LENSPROF_REASON_MISSING_GREYS || reason == LENSPROF_REASON_RESPONSE_NOT_SHOWN;
}

// Calls change(verdict) for the result's verdict and those of its lens settings.
template <class Change>
void for_each_verdict(FitResult &r, Change change) {
    change(r);
    for (uint32_t n = 0; n < r.setting_count; n++)
        if (r.settings[n].images) change(r.settings[n]);
}

// Marks a result as usable, without a warning.
template <class Result>
void accept(Result &r) {
    give_reason(r, {LENSPROF_REASON_NONE, {}}, true);
}

}  // namespace lensprof
