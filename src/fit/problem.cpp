#include "problem.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/response.h"

namespace lensprof {
namespace {

uint32_t find_root(std::vector<uint32_t> &parent, uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

void find_edges(Problem &problem) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> index;
    for (const auto &pair : problem.pairs) index[std::minmax(pair.image[0], pair.image[1])] = 0;
    for (auto &[images, number] : index) {
        number = static_cast<uint32_t>(problem.edges.size());
        problem.edges.push_back({{images.first, images.second}});
    }
    problem.edge_of_pair.reserve(problem.pairs.size());
    for (const auto &pair : problem.pairs)
        problem.edge_of_pair.push_back(index[std::minmax(pair.image[0], pair.image[1])]);
}

void find_components(Problem &problem) {
    std::vector<uint32_t> parent(problem.image_count);
    std::iota(parent.begin(), parent.end(), 0u);
    for (const auto &edge : problem.edges) {
        uint32_t a = find_root(parent, edge.image[0]), b = find_root(parent, edge.image[1]);
        parent[std::max(a, b)] = std::min(a, b);
    }
    for (uint32_t i = 0; i < problem.image_count; i++) problem.component.push_back(find_root(parent, i));
}

// The column of the unknown that image `of` owns, made on first use; -1 when it is fixed there.
int unknown_of(std::vector<int> &columns, uint32_t of, bool is_free, int &count) {
    if (!is_free) return -1;
    if (columns[of] < 0) columns[of] = count++;
    return columns[of];
}

void number_unknowns(Problem &problem) {
    std::vector<int> ev(problem.image_count, -1), red = ev, blue = ev;
    for (uint32_t i = 0; i < problem.image_count; i++) {
        const auto &image = problem.images[i];
        auto is_free = [&](uint32_t of, uint32_t flag) {
            bool is_reference = of == problem.reference
                || (flag == LENSPROF_FREE_EV ? problem.images[problem.reference].ev_of
                    : flag == LENSPROF_FREE_RED ? problem.images[problem.reference].red_of
                                                : problem.images[problem.reference].blue_of) == of;
            return !is_reference && (problem.images[of].free & flag);
        };
        int &n = problem.image_unknowns;
        problem.ev_unknown.push_back(unknown_of(ev, image.ev_of, is_free(image.ev_of, LENSPROF_FREE_EV), n));
        std::array<int, 3> balance{-1, -1, -1};
        if (problem.channels == 3) {
            balance[0] = unknown_of(red, image.red_of, is_free(image.red_of, LENSPROF_FREE_RED), n);
            balance[2] = unknown_of(blue, image.blue_of, is_free(image.blue_of, LENSPROF_FREE_BLUE), n);
        }
        problem.balance_unknown.push_back(balance);
    }
}

}  // namespace

uint32_t Problem::component_count() const {
    uint32_t count = 0;
    for (uint32_t i = 0; i < image_count; i++) count += component[i] == i;
    return count;
}

Problem make_problem(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                     const lensprof_pair *pairs, const std::vector<uint32_t> &keep) {
    Problem problem;
    problem.channels = static_cast<int>(options.channels);
    problem.reference = options.reference;
    problem.free = options.free;
    problem.images = images;
    problem.image_count = image_count;
    problem.pairs.reserve(keep.size());
    for (uint32_t p : keep) problem.pairs.push_back(pairs[p]);
    find_edges(problem);
    find_components(problem);
    number_unknowns(problem);
    return problem;
}

void set_response(Estimate &estimate, const double *emor, int modes) {
    estimate.modes = modes;
    std::array<double, kMaxModes> copy{};
    std::copy(emor, emor + modes, copy.begin());
    estimate.emor = copy;
    lp_emor_curve(copy.data(), static_cast<uint32_t>(modes), estimate.table.data());
}

}  // namespace lensprof
