#include "photo/reconstruction/link_order.hpp"

#include <algorithm>
#include <deque>
#include <unordered_map>

namespace lensprof {

LinkWeights common_points(const Reconstruction &r) {
    constexpr size_t longest = 64;
    const auto &all = r.observations;
    std::unordered_map<uint64_t, uint32_t> counts;  // millions of additions
    for (size_t first = 0, last = 0; first < all.size(); first = last) {
        for (last = first; last < all.size() && all[last].point == all[first].point;) last++;
        if (last - first > longest) continue;
        for (size_t a = first; a < last; a++)
            for (size_t b = a + 1; b < last; b++) counts[uint64_t{all[a].image} << 32 | all[b].image]++;
    }
    LinkWeights links;
    for (const auto &[link, count] : counts)
        links[{static_cast<uint32_t>(link >> 32), static_cast<uint32_t>(link)}] = count;
    return links;
}

std::vector<uint32_t> order_by_links(uint32_t images, const LinkWeights &links) {
    struct Neighbour {
        uint32_t weight, image;
    };
    std::vector<std::vector<Neighbour>> neighbours(images);
    for (const auto &[link, weight] : links) {
        neighbours[link.first].push_back({weight, link.second});
        neighbours[link.second].push_back({weight, link.first});
    }
    for (auto &list : neighbours)
        std::sort(list.begin(), list.end(), [](const Neighbour &a, const Neighbour &b) {
            return a.weight != b.weight ? a.weight > b.weight : a.image < b.image;
        });
    std::vector<uint32_t> order;
    std::vector<bool> is_met(images);
    for (uint32_t start = 0; start < images; start++) {
        if (is_met[start]) continue;
        std::deque<uint32_t> next{start};
        for (is_met[start] = true; !next.empty(); next.pop_front()) {
            order.push_back(next.front());
            for (const Neighbour &neighbour : neighbours[next.front()])
                if (!is_met[neighbour.image]) is_met[neighbour.image] = true, next.push_back(neighbour.image);
        }
    }
    return order;
}

}  // namespace lensprof
