// Pairs of consecutive observations of a point.
#pragma once

#include <algorithm>
#include <vector>

#include <lensprof/sample.h>

namespace lensprof {

// Appends them, among those of the observations in [first, last) that `takes` accepts.
template <class Takes>
void add_track_pairs(const lensprof_observation *first, const lensprof_observation *last, const Takes &takes,
                     std::vector<lensprof_pair> &pairs) {
    const lensprof_observation *before = nullptr;
    for (const lensprof_observation *next = first; next != last; next++) {
        if (!takes(*next)) continue;
        if (before && before->point == next->point) {
            lensprof_pair pair{};
            const lensprof_observation *ends[2] = {before, next};
            for (int side = 0; side < 2; side++) {
                pair.image[side] = ends[side]->image;
                std::copy(ends[side]->xy, ends[side]->xy + 2, pair.xy[side]);
                std::copy(ends[side]->value, ends[side]->value + 3, pair.value[side]);
            }
            pairs.push_back(pair);
        }
        before = next;
    }
}

}  // namespace lensprof
