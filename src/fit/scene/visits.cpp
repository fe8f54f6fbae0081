#include "fit/scene/visits.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "fit/base/joined_sets.hpp"
#include "fit/base/quantile.hpp"
#include "fit/verdict/limits.hpp"

namespace lensprof {
namespace {

constexpr size_t kMinPairs = 8;            // of an informative link
constexpr size_t kMinImages = 3;           // of a group
constexpr double kMinDifference = 0.25;    // levels of 255 squared: the effect of rounding
constexpr size_t kMaxCandidates = 200;     // links that may separate the images
constexpr double kMaxDistanceRatio = 1.2;  // of the usual distance of views

struct Link {
    double difference, distance;  // of colours, and of views
    uint32_t image[2];
};

// The links with enough pairs, the most similar first.
std::vector<Link> links_of(const SceneData &data, const std::vector<double> &differences) {
    struct Values {
        std::vector<double> differences;
        double distance;
    };
    std::map<std::pair<uint32_t, uint32_t>, Values> of_link;
    for (size_t p = 0; p < data.pairs.size(); p++) {
        if (std::isnan(differences[p])) continue;
        Values &values = of_link[std::minmax(data.pairs[p].image[0], data.pairs[p].image[1])];
        values.differences.push_back(differences[p]);
        values.distance += ((data.distances.empty() ? 0.0 : data.distances[p]) - values.distance)
                           / static_cast<double>(values.differences.size());  // the mean
    }
    std::vector<Link> links;
    for (auto &[images, values] : of_link)
        if (values.differences.size() >= kMinPairs)
            links.push_back({median(values.differences), values.distance, {images.first, images.second}});
    std::stable_sort(links.begin(), links.end(),
                     [](const Link &a, const Link &b) { return a.difference < b.difference; });
    return links;
}

// The smaller of the two groups left by removing one link from the tree.
std::vector<uint32_t> smaller_group(const std::vector<Link> &tree, size_t without, uint32_t images) {
    JoinedSets groups(images);
    for (size_t n = 0; n < tree.size(); n++)
        if (n != without) groups.join(tree[n].image[0], tree[n].image[1]);
    std::vector<uint32_t> sides[2];
    for (uint32_t i = 0; i < images; i++)
        for (const int side : {0, 1})
            if (groups.of(i) == groups.of(tree[without].image[side])) sides[side].push_back(i);
    return sides[0].size() <= sides[1].size() ? sides[0] : sides[1];
}

// The minimum spanning tree of sorted links (Kruskal 1956).
std::vector<Link> tree_of(const std::vector<Link> &links, uint32_t images) {
    JoinedSets groups(images);
    std::vector<Link> tree;
    for (const Link &link : links)
        if (groups.join(link.image[0], link.image[1])) tree.push_back(link);
    return tree;
}

template <class Value>
double median_of(const std::vector<Link> &links, Value value) {
    std::vector<double> values;
    for (const Link &link : links) values.push_back(value(link));
    return median(values);
}

}  // namespace

Visits find_visits(uint32_t image_count, const SceneData &data, const std::vector<double> &differences) {
    const std::vector<Link> links = links_of(data, differences), tree = tree_of(links, image_count);
    Visits found;
    if (tree.size() < 2 * kMinImages - 1) return found;
    const double usual = std::max(median_of(tree, [](const Link &link) { return link.difference; }), kMinDifference),
                 usual_distance = median_of(tree, [](const Link &link) { return link.distance; });
    size_t candidates = 0;
    for (size_t n = tree.size(); n-- > 0 && tree[n].difference > kVisitRatio * usual && candidates < kMaxCandidates;
         candidates++) {
        std::vector<uint32_t> group = smaller_group(tree, n, image_count);
        if (group.size() < kMinImages) continue;
        const auto is_in = [&](uint32_t image) { return std::binary_search(group.begin(), group.end(), image); };
        std::vector<double> within{usual};  // the group may vary more internally than the rest
        for (const Link &link : tree)
            if (is_in(link.image[0]) && is_in(link.image[1])) within.push_back(link.difference);
        const double usual_of_group = std::max(usual, median(within));
        const auto is_comparable = [&](const Link &link) {
            return is_in(link.image[0]) != is_in(link.image[1]) && link.distance <= kMaxDistanceRatio * usual_distance;
        };
        const auto nearest = std::find_if(links.begin(), links.end(), is_comparable);  // the most similar of them
        if (nearest == links.end() || nearest->difference <= kVisitRatio * usual_of_group) continue;
        found.ratio = nearest->difference / usual_of_group;
        found.second = std::move(group);
        break;
    }
    return found;
}

}  // namespace lensprof
