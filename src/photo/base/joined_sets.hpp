// Disjoint sets of connected items (union-find with path halving).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace lensprof {

class JoinedSets {
public:
    explicit JoinedSets(size_t items) : parent_(items) { std::iota(parent_.begin(), parent_.end(), 0u); }

    // The smallest item of the set that contains an item.
    uint32_t of(uint32_t item) {
        while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
        return item;
    }

    // Joins two sets; false if they were joined already.
    bool join(uint32_t a, uint32_t b) {
        a = of(a), b = of(b);
        parent_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

private:
    std::vector<uint32_t> parent_;
};

}  // namespace lensprof
