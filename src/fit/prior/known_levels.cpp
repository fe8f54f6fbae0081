#include "fit/prior/known_levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fit/base/constants.hpp"
#include "fit/base/joined_sets.hpp"
#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

constexpr double kChanceScatter = 2.0;  // standard errors: a scatter up to this may be chance
constexpr double kJump = 4.0;           // standard errors of a difference between neighbours that agree
constexpr int kReach = 6;               // neighbours that an image is compared with, one after the other
constexpr size_t kMinDistances = 3;     // distances needed

using Tree = std::vector<std::vector<uint32_t>>;

// Neighbours of each image in the maximum spanning tree of its group (Kruskal 1956).
Tree spanning_tree(const Problem &problem) {
    std::vector<Edge> edges = problem.edges;
    std::stable_sort(edges.begin(), edges.end(),
                     [](const Edge &a, const Edge &b) { return a.last - a.first > b.last - b.first; });
    JoinedSets joined(problem.image_count);
    Tree tree(problem.image_count);
    for (const Edge &edge : edges) {
        if (!joined.join(edge.image[0], edge.image[1])) continue;
        tree[edge.image[0]].push_back(edge.image[1]);
        tree[edge.image[1]].push_back(edge.image[0]);
    }
    return tree;
}

// An end of the tree: a wrong exposure there does not divide the tree.
uint32_t end_of(const Problem &problem, const Tree &tree) {
    for (uint32_t i = 0; i < problem.image_count; i++)
        if (tree[i].size() == 1 && problem.component[i] == problem.component[problem.reference]) return i;
    return problem.reference;
}

}  // namespace

double scatter_of(std::vector<double> distances, size_t parameters) {
    if (distances.size() < kMinDistances || distances.size() <= parameters) return 1.0;
    const double count = static_cast<double>(distances.size());
    const double scatter =
        kMadToSigma * upper_median(std::move(distances)) * std::sqrt(count / (count - static_cast<double>(parameters)));
    return std::sqrt(1.0 + std::max(0.0, scatter * scatter - kChanceScatter * kChanceScatter));
}

KnownNeighbours::KnownNeighbours(const Problem &problem, const std::vector<bool> &is_known) {
    const Tree tree = spanning_tree(problem);
    struct Step {
        uint32_t image, from;
        int before;
    };
    std::vector<Step> open{{end_of(problem, tree), problem.image_count, -1}};
    while (!open.empty()) {
        const Step step = open.back();
        open.pop_back();
        int before = step.before;
        if (is_known[step.image]) {
            visits_.push_back({step.image, before});
            before = static_cast<int>(visits_.size()) - 1;
        }
        for (uint32_t next : tree[step.image])
            if (next != step.from) open.push_back({next, step.image, before});
    }
}

double KnownNeighbours::scatter(const std::vector<double> &off, const std::vector<double> &sigma) const {
    std::vector<double> distances;
    for (const Visit &visit : visits_) {
        if (visit.before < 0) continue;
        const uint32_t i = visit.image, k = visits_[static_cast<size_t>(visit.before)].image;
        distances.push_back(std::abs(off[i] - off[k]) / std::hypot(sigma[i], sigma[k]));
    }
    return distances.size() < kMinDistances ? std::numeric_limits<double>::infinity() : scatter_of(distances, 0);
}

std::vector<int> KnownNeighbours::levels(const std::vector<double> &off, const std::vector<double> &sigma,
                                         double scatter) const {
    std::vector<int> level(off.size(), -1);
    int count = 0;
    for (const Visit &visit : visits_) {
        const uint32_t i = visit.image;
        int before = visit.before;
        for (int reach = 0; reach < kReach && before >= 0 && level[i] < 0; reach++) {
            const Visit &other = visits_[static_cast<size_t>(before)];
            const uint32_t k = other.image;
            if (std::abs(off[i] - off[k]) <= kJump * scatter * std::hypot(sigma[i], sigma[k])) level[i] = level[k];
            before = other.before;
        }
        if (level[i] < 0) level[i] = count++;
    }
    return level;
}

}  // namespace lensprof
