// A part of the work, to distribute it over several machines.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lensprof {

struct Shard {
    uint32_t number = 1, count = 1;  // 1-based

    // The items of this part are first(items) to end(items), exclusive: each item belongs to exactly one part.
    size_t first(size_t items) const { return items * (number - 1) / count; }
    size_t end(size_t items) const { return items * number / count; }
};

}  // namespace lensprof
