// A balanced choice among candidates.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace lensprof {

constexpr int kRadiusBins = 10, kGreyBins = 10;

// Selects `wanted` of `count` candidates and returns their numbers, ascending: those of lowest gradient(i) first, as
// long as no group, radius or grey level exceeds its share; the shares grow until enough are found. group(i) is below
// `groups`; ends(i, use) calls use(radius bin, grey bin) for each of a candidate's ends; all wanted candidates together
// have `wanted_ends`.
template <class Gradient, class Group, class Ends>
std::vector<uint32_t> balance(size_t count, uint32_t wanted, double wanted_ends, uint32_t groups, Gradient gradient,
                              Group group, Ends ends) {
    std::vector<uint32_t> order(count), group_of(count), chosen;
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return gradient(a) != gradient(b) ? gradient(a) < gradient(b) : a < b; });
    std::vector<bool> seen(groups, false), taken(count, false);
    for (uint32_t n = 0; n < count; n++) seen[group_of[n] = group(n)] = true;
    const auto held = std::max<ptrdiff_t>(std::count(seen.begin(), seen.end(), true), 1);
    std::vector<uint32_t> per_group(groups, 0), per_radius(kRadiusBins, 0), per_grey(kGreyBins, 0);
    for (double share : {1.0, 1.5, 2.0, 3.0, 5.0, 1e9}) {
        double group_limit = share * wanted / static_cast<double>(held);
        double radius_limit = share * wanted_ends / kRadiusBins, grey_limit = share * wanted_ends / kGreyBins;
        for (uint32_t index : order) {
            if (chosen.size() >= wanted) break;
            bool fits = !taken[index] && per_group[group_of[index]] < group_limit;
            if (fits)
                ends(index, [&](int radius, int grey) {
                    fits = fits && per_radius[static_cast<size_t>(radius)] < radius_limit
                           && per_grey[static_cast<size_t>(grey)] < grey_limit;
                });
            if (!fits) continue;
            taken[index] = true;
            chosen.push_back(index);
            per_group[group_of[index]]++;
            ends(index, [&](int radius, int grey) {
                per_radius[static_cast<size_t>(radius)]++, per_grey[static_cast<size_t>(grey)]++;
            });
        }
    }
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

}  // namespace lensprof
