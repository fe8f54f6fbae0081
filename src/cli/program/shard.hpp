// A part of the work for one of several machines, as farms of command lines start them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace lensprof {

struct Shard {
    uint32_t number = 1, count = 1;  // the first is 1

    // The items of this part are from first(items) to end(items), not included: all parts together have each item once.
    size_t first(size_t items) const { return items * (number - 1) / count; }
    size_t end(size_t items) const { return items * number / count; }
};

// "2/5"; the whole for an empty word. Failure (usage) names the option --shard.
Shard shard_of(const std::string &word);

}  // namespace lensprof
