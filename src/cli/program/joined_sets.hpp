// Which of many items are joined, directly or through others: disjoint sets with path halving.
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

    // The smallest item of the set that an item is in.
    uint32_t of(uint32_t item) {
        while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
        return item;
    }

    // False where the two were joined already.
    bool join(uint32_t a, uint32_t b) {
        a = of(a), b = of(b);
        parent_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

private:
    std::vector<uint32_t> parent_;
};

}  // namespace lensprof
