// What the fits that a caller holds have in common: blocks of memory, and answers.
#pragma once

#include <algorithm>
#include <cstdint>

#include <lensprof/base.h>

#include "fit/base/sized.hpp"
#include "fit/verdict/finding.hpp"

namespace lensprof {

// Where a fit goes: the caller's memory, or the library's if it is NULL.
struct Place {
    void *memory;
    size_t size;
};

inline lensprof_status check_place(const Place &place, size_t needed, const char *what, lensprof_error *error) {
    if (place.memory && (place.size < needed || reinterpret_cast<uintptr_t>(place.memory) % 8 != 0))
        return fail(LENSPROF_ERROR_CAPACITY, error,
                    "%s: it needs %zu bytes of memory, aligned to 8; see lensprof_%s_bytes", what, needed, what);
    return LENSPROF_OK;
}

// Takes `count` elements from a block; all types have a size that is a multiple of 8.
template <class T>
T *take_block(char *&block, size_t count) {
    static_assert(sizeof(T) % 8 == 0, "the next element would not be aligned");
    T *const first = reinterpret_cast<T *>(block);
    block += count * sizeof(T);
    return first;
}

// ARGUMENT for NULL and a released fit, whose mark is not `mark`.
template <class Held>
lensprof_status check_held(const Held *held, const void *result, uint32_t mark, const char *what,
                           lensprof_error *error) {
    clear(error);
    if (!held || !result) return fail(LENSPROF_ERROR_ARGUMENT, error, "%s: a pointer is NULL", what);
    if (held->mark != mark)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "%s: it was released, or is not one; pass what a fit returned",
                    what);
    return LENSPROF_OK;
}

// The same, and for a part beyond `count`.
template <class Held>
lensprof_status check_part(const Held *held, const void *result, uint32_t mark, const char *what, uint32_t number,
                           uint32_t count, const char *part, lensprof_error *error) {
    const lensprof_status status = check_held(held, result, mark, what, error);
    if (status == LENSPROF_OK && number >= count)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "%s: it has no %s %u, but %u, counted from 0", what, part, number,
                    count);
    return status;
}

// Copies a part to the caller's struct, which has at least the `first` bytes of the first version.
template <class T>
lensprof_status give(const T &found, T *given, size_t first, const char *what, lensprof_error *error) {
    if (const char *wrong = lp_sized_wrong(given, first, sizeof found))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "%s: %s", what, wrong);
    lp_sized_copy(given, &found);
    return LENSPROF_OK;
}

// Copies findings into the block of a held fit, and counts them in its result.
template <class Result>
void hold_findings(const Findings &findings, size_t capacity, lensprof_finding *held, Result &result) {
    const size_t count = std::min(findings.size(), capacity);
    std::copy_n(findings.begin(), count, held);
    result.findings = std::min(count_findings(findings), static_cast<uint32_t>(count));
    result.passed = static_cast<uint32_t>(count) - result.findings;
}

// The finding with this index, of those of a result.
template <class Result>
lensprof_status give_finding(const lensprof_finding *held, const Result &result, uint32_t index,
                             lensprof_finding *finding, const char *what, lensprof_error *error) {
    const uint32_t count = result.findings + result.passed;
    if (index >= count)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "%s: it has no finding %u, but %u, counted from 0", what, index,
                    count);
    return give(held[index], finding, LP_END_OF(lensprof_finding, text), what, error);
}

}  // namespace lensprof
