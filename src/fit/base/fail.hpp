// Error texts of the C functions in this layer.
#pragma once

#include <cstddef>

#include <lensprof/base.h>

namespace lensprof {

// Writes a formatted message into `error` (may be NULL) and returns `status`.
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
lensprof_status
fail(lensprof_status status, lensprof_error *error, const char *format, ...);

// The same, prefixed with the item and its number: "image 3: ".
#if defined(__GNUC__)
__attribute__((format(printf, 5, 6)))
#endif
lensprof_status
fail_at(lensprof_item_kind kind, uint32_t index, lensprof_status status, lensprof_error *error, const char *format,
        ...);

// Name of a lensprof_item_kind: "image", "pair", ...
const char *item_word(uint32_t kind);

// Resets `error` (may be NULL) to "no error".
inline void clear(lensprof_error *error) {
    if (error) *error = lensprof_error{};
}

// A condition on an option, with the option's name and allowed range for an error text.
struct Rule {
    bool holds;
    const char *text;
};

// Text of the first rule that does not hold; NULL if all hold.
template <size_t count>
const char *first_broken(const Rule (&rules)[count]) {
    for (const Rule &rule : rules)
        if (!rule.holds) return rule.text;
    return nullptr;
}

}  // namespace lensprof
