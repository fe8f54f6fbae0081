#include "cli/fitting/light_groups.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "cli/program/joined_sets.hpp"
#include "cli/program/median.hpp"

namespace lensprof {
namespace {

constexpr size_t kLeastPairs = 8;          // of an informative link
constexpr size_t kLeastImages = 3;         // of a group
constexpr double kLeastRatio = 8.0;        // of variances between and within
constexpr double kLeastDifference = 0.25;  // levels of 255 squared: the effect of rounding
constexpr size_t kMostLooked = 200;        // links that may separate the images
constexpr double kNear = 1.2;              // of the usual distance of views

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
        if (values.size() >= kLeastPairs)
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
    std::vector<double> all, far;
    for (const Link &link : links) {
        if (!groups.join(link.image[0], link.image[1])) continue;
        tree.push_back(link);
        all.push_back(link.difference), far.push_back(link.distance);
    }
    LightGroups found;
    if (tree.size() < 2 * kLeastImages - 1) return found;
    const double usual = std::max(median(all), kLeastDifference), usual_distance = median(far);
    size_t looked = 0;
    for (size_t n = tree.size(); n-- > 0 && tree[n].difference > kLeastRatio * usual && looked < kMostLooked;
         looked++) {
        std::vector<uint32_t> group = smaller_group(tree, n, input.images.size());
        if (group.size() < kLeastImages) continue;
        const auto is_in = [&](uint32_t image) { return std::binary_search(group.begin(), group.end(), image); };
        std::vector<double> within{usual};  // the group may vary more internally than the rest
        for (const Link &link : tree)
            if (is_in(link.image[0]) && is_in(link.image[1])) within.push_back(link.difference);
        const double most = kLeastRatio * std::max(usual, median(within));
        const auto is_comparable = [&](const Link &link) {
            return is_in(link.image[0]) != is_in(link.image[1]) && link.distance <= kNear * usual_distance;
        };
        const auto nearest = std::find_if(links.begin(), links.end(), is_comparable);  // the most similar of them
        if (nearest == links.end() || nearest->difference <= most) continue;
        found.ratio = kLeastRatio * nearest->difference / most;
        found.second = std::move(group);
        break;
    }
    return found;
}

}  // namespace lensprof
