#include "cli/fitting/light_groups.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "cli/program/joined_sets.hpp"
#include "cli/program/median.hpp"

namespace lensprof {
namespace {

constexpr size_t kMinPairs = 8;            // of an informative link
constexpr size_t kMinImages = 3;           // of a group
constexpr double kMinRatio = 8.0;          // of variances between and within
constexpr double kMinDifference = 0.25;    // levels of 255 squared: the effect of rounding
constexpr size_t kMaxCandidates = 200;     // links that may separate the images
constexpr double kMaxDistanceRatio = 1.2;  // of the usual distance of views

struct Link {
    double difference, distance;  // of colours, and of views
    uint32_t image[2];
};

using Distances = std::map<std::pair<uint32_t, uint32_t>, double>;

std::vector<Link> links_of(const FitInput &input, const std::vector<double> &differences, const Distances &of_views) {
    std::map<std::pair<uint32_t, uint32_t>, std::vector<double>> of_link;
    for (size_t p = 0; p < input.pairs.size(); p++)
        if (!std::isnan(differences[p]))
            of_link[std::minmax(input.pairs[p].image[0], input.pairs[p].image[1])].push_back(differences[p]);
    std::vector<Link> links;
    for (const auto &[images, values] : of_link)
        if (values.size() >= kMinPairs)
            links.push_back({median(values), of_views.at(images), {images.first, images.second}});
    std::stable_sort(links.begin(), links.end(),
                     [](const Link &a, const Link &b) { return a.difference < b.difference; });
    return links;
}

// The smaller of the two groups left by removing one link from the tree.
std::vector<uint32_t> smaller_group(const std::vector<Link> &tree, size_t without, size_t images) {
    JoinedSets groups(images);
    for (size_t n = 0; n < tree.size(); n++)
        if (n != without) groups.join(tree[n].image[0], tree[n].image[1]);
    std::vector<uint32_t> sides[2];
    for (uint32_t i = 0; i < images; i++)
        for (const int side : {0, 1})
            if (groups.of(i) == groups.of(tree[without].image[side])) sides[side].push_back(i);
    return sides[0].size() <= sides[1].size() ? sides[0] : sides[1];
}

}  // namespace

LightGroups light_groups(const FitInput &input, const std::vector<double> &differences, const Distances &of_views) {
    const std::vector<Link> links = links_of(input, differences, of_views);
    JoinedSets groups(input.images.size());
    std::vector<Link> tree;
    std::vector<double> tree_differences, tree_distances;
    for (const Link &link : links) {
        if (!groups.join(link.image[0], link.image[1])) continue;
        tree.push_back(link);
        tree_differences.push_back(link.difference), tree_distances.push_back(link.distance);
    }
    LightGroups found;
    if (tree.size() < 2 * kMinImages - 1) return found;
    const double typical_difference = std::max(median(tree_differences), kMinDifference),
                 typical_distance = median(tree_distances);
    size_t candidates = 0;
    for (size_t n = tree.size();
         n-- > 0 && tree[n].difference > kMinRatio * typical_difference && candidates < kMaxCandidates; candidates++) {
        std::vector<uint32_t> group = smaller_group(tree, n, input.images.size());
        if (group.size() < kMinImages) continue;
        const auto is_in = [&](uint32_t image) { return std::binary_search(group.begin(), group.end(), image); };
        std::vector<double> group_differences{typical_difference};  // the group may vary more internally than the rest
        for (const Link &link : tree)
            if (is_in(link.image[0]) && is_in(link.image[1])) group_differences.push_back(link.difference);
        const double max_difference = kMinRatio * std::max(typical_difference, median(group_differences));
        const auto is_comparable = [&](const Link &link) {
            return is_in(link.image[0]) != is_in(link.image[1])
                   && link.distance <= kMaxDistanceRatio * typical_distance;
        };
        const auto nearest = std::find_if(links.begin(), links.end(), is_comparable);  // the most similar of them
        if (nearest == links.end() || nearest->difference <= max_difference) continue;
        found.ratio = kMinRatio * nearest->difference / max_difference;
        found.second = std::move(group);
        break;
    }
    return found;
}

}  // namespace lensprof
