// Conversion of arrays of extensible structs between the caller's struct version and this library's.
#pragma once

#include <cstddef>
#include <vector>

#include "core/sized.h"
#include "fit/base/fail.hpp"

namespace lensprof {

// Copies the caller's array into structs of this library's version; init(struct, its index) sets the defaults first.
// The struct_size of the first element applies to all elements and is the stride of the array.
template <class T, class Init>
lensprof_status take_all(const T *given, uint32_t count, size_t first, lensprof_item_kind kind, Init init,
                         std::vector<T> &converted, lensprof_error *error) {
    for (uint32_t i = 0; i < count; i++) {
        if (!lp_sized_is_alike(given, i))
            return fail_at(kind, i, LENSPROF_ERROR_STRUCT_SIZE, error,
                           "struct_size differs from that of %s 0; call the struct's _init function first",
                           item_word(kind));
        T next;
        init(next, i);
        if (const char *wrong = lp_sized_take(&next, lp_sized_at(given, i), first))
            return fail_at(kind, i, LENSPROF_ERROR_STRUCT_SIZE, error, "%s", wrong);
        converted.push_back(next);
    }
    return LENSPROF_OK;
}

}  // namespace lensprof
