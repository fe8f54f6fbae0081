// Conversion of arrays of extensible structs between the caller's struct version and this library's.
#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

#include "core/sized.h"
#include "fit/base/fail.hpp"

namespace lensprof {

// Copies the caller's array into structs of this library's version; init(struct, its index) sets the defaults first.
// The struct_size of the first element applies to all elements and is the stride of the array.
template <class T, class Init>
lensprof_status take_all(const T *given, uint32_t count, size_t first, lensprof_item_kind kind, Init init,
                         std::vector<T> &converted, lensprof_error *error) {
    const auto *bytes = reinterpret_cast<const char *>(given);
    const size_t step = count ? lp_sized_bytes(given) : 0;
    for (uint32_t i = 0; i < count; i++) {
        const char *element = bytes + i * step;
        if (lp_sized_bytes(element) != step)
            return fail_at(kind, i, LENSPROF_ERROR_STRUCT_SIZE, error,
                           "struct_size differs from that of %s 0; call the struct's _init function first",
                           item_word(kind));
        T next;
        init(next, i);
        if (const char *wrong = lp_sized_take(&next, element, first))
            return fail_at(kind, i, LENSPROF_ERROR_STRUCT_SIZE, error, "%s", wrong);
        converted.push_back(next);
    }
    return LENSPROF_OK;
}

// Copies the per-image results into the caller's array, as many bytes of each as the caller's struct has.
template <class T>
void give_all(const std::vector<T> &quality, T *given, size_t step) {
    for (size_t i = 0; i < quality.size(); i++)
        std::memcpy(reinterpret_cast<char *>(given) + i * step, &quality[i], step);
}

// Rejects the caller's result, or the size of its image_quality, if it is incompatible with this library's structs.
template <class Result, class Quality>
lensprof_status check_result(const Result &result, size_t first, size_t first_quality, const Quality *quality,
                             const char *item, lensprof_error *error) {
    if (const char *wrong = lp_sized_wrong(&result, first, sizeof result))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "%s: %s", item, wrong);
    if (quality && (result.image_quality_size < first_quality || result.image_quality_size > sizeof *quality))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error,
                    "%s: image_quality_size is not set, or set by a newer lensprof; call the result's _init function",
                    item);
    return LENSPROF_OK;
}

// Copies the result `found` and its image_quality to the caller's; the caller's size, array and stride stay.
template <class Result, class Quality>
void give_result(Result &found, const std::vector<Quality> &quality, Result *given) {
    found.image_quality = given->image_quality;
    found.image_quality_size = given->image_quality_size;
    if (given->image_quality) give_all(quality, given->image_quality, given->image_quality_size);
    lp_sized_copy(given, &found);
}

}  // namespace lensprof
