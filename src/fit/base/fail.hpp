// Error texts of the layer's C functions.
#pragma once

#include <cstddef>

#include <lensprof/base.h>

namespace lensprof {

// Puts a formatted sentence into `error` (may be NULL) and returns `status`.
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
lensprof_status
fail(lensprof_status status, lensprof_error *error, const char *format, ...);

// The same about an item by its number: "image 3: " and the sentence.
#if defined(__GNUC__)
__attribute__((format(printf, 5, 6)))
#endif
lensprof_status
fail_at(lensprof_item_kind kind, uint32_t index, lensprof_status status, lensprof_error *error, const char *format,
        ...);

// "image", "pair", ... of lensprof_item_kind.
const char *item_word(uint32_t kind);

// Nothing has gone wrong yet; `error` may be NULL.
inline void clear(lensprof_error *error) {
    if (error) *error = lensprof_error{};
}

// A condition on an option, and the option with its allowed range, for an error text.
struct Rule {
    bool holds;
    const char *text;
};

// The text of the first rule that does not hold; NULL when all do.
template <size_t count>
const char *first_broken(const Rule (&rules)[count]) {
    for (const Rule &rule : rules)
        if (!rule.holds) return rule.text;
    return nullptr;
}

}  // namespace lensprof
