// Correspondences at places that are known to match: the patch with the lowest gradient near each match at which both
// pictures show the same.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "fit/sampling/sampler.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kMatchesPerPiece = 32;  // matches that a thread processes as a unit
constexpr size_t kMatchesPerWanted = 16;   // matches examined per wanted pair
// Features lie on edges and corners, where a misplacement of one pixel is visible. Places at this distance, view
// pixels, may have a lower gradient; the map of the surroundings is valid at that distance for any scene.
constexpr int kRings = 2;
constexpr double kRing = 4.0;

// At most `max_per_link` of every link, evenly chosen, in the original order.
std::vector<uint32_t> thinned(const lensprof_match *matches, uint32_t count, size_t max_per_link,
                              const std::function<uint32_t(const lensprof_match &)> &link_of, uint32_t links) {
    std::vector<size_t> of_link(links), seen(links);
    for (uint32_t m = 0; m < count; m++) of_link[link_of(matches[m])]++;
    std::vector<uint32_t> kept;
    for (uint32_t m = 0; m < count; m++) {
        const uint32_t link = link_of(matches[m]);
        const size_t n = seen[link]++, all = of_link[link];
        if (all <= max_per_link || n * max_per_link / all != (n + 1) * max_per_link / all) kept.push_back(m);
    }
    return kept;
}

}  // namespace

Sampler::Sampler(const lensprof_sample_options &options, const lensprof_sample_image *images, uint32_t count,
                 const lensprof_match *matches, uint32_t match_count)
    : options_(options), by_matches_(true) {
    for (uint32_t i = 0; i < count; i++) views_.emplace_back(images[i]);
    neighbours_.resize(count);
    for (uint32_t m = 0; m < match_count; m++)
        for (const int side : {0, 1}) neighbours_[matches[m].image[side]].push_back(matches[m].image[1 - side]);
    for (auto &list : neighbours_) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    number_edges();
}

// The patch with the lowest gradient around a match; false if none can be measured, or if the two pictures do not show
// the same there.
bool Sampler::flattest_place(const lensprof_match &match, MatchCandidate &found) {
    const bool has_map = match.map[0][0] != 0.0 || match.map[0][1] != 0.0;
    const int rings = has_map ? kRings : 0;
    const double step = kRing * views_[match.image[0]].image().reduction;
    struct Place {
        double xy[2][2];
        End end[2];
        double gradient() const { return end[0].patch.gradient + end[1].patch.gradient; }
    };
    std::vector<Place> places;
    for (int b = -rings; b <= rings; b++)
        for (int a = -rings; a <= rings; a++) {
            const double off[2] = {a * step, b * step};
            Place p{};
            bool good = true;
            for (int d = 0; d < 2; d++) {
                p.xy[0][d] = match.xy[0][d] + off[d];
                p.xy[1][d] = match.xy[1][d] + match.map[d][0] * off[0] + match.map[d][1] * off[1];
            }
            for (int side = 0; side < 2 && good; side++) {
                const double *xy = p.xy[side];
                good = views_[match.image[side]].holds(xy[0], xy[1])
                       && measure(match.image[side], xy[0], xy[1], p.end[side]);
            }
            if (good) places.push_back(p);
        }
    const auto flattest = std::min_element(places.begin(), places.end(),
                                           [](const Place &a, const Place &b) { return a.gradient() < b.gradient(); });
    if (flattest == places.end()) return false;
    const Place &p = *flattest;
    if (has_map) {
        const auto &map = match.map;
        const Sight sight{p.xy[1][0], p.xy[1][1], {{map[0][0], map[0][1]}, {map[1][0], map[1][1]}}};
        if (!is_alike(match.image[0], p.xy[0][0], p.xy[0][1], match.image[1], sight)) return false;
    }
    found.gradient = static_cast<float>(p.gradient());
    found.pair = {{match.image[0], match.image[1]}, {}, {}};
    std::copy(match.image, match.image + 2, found.image);
    found.x = p.xy[0][0], found.y = p.xy[0][1];
    for (int side = 0; side < 2; side++) {
        std::copy(p.xy[side], p.xy[side] + 2, found.pair.xy[side]);
        std::copy(p.end[side].patch.value, p.end[side].patch.value + 3, found.pair.value[side]);
        found.radius[side] = p.end[side].radius, found.grey[side] = p.end[side].grey;
    }
    return true;
}

std::vector<lensprof_pair> Sampler::of_matches(const lensprof_match *matches, uint32_t count, uint32_t wanted,
                                               uint32_t *match_of_pair) {
    overlaps_ = count > 0;
    likenesses_ = std::vector<Likenesses>(edge_numbers_);
    read_grey_levels();
    size_t links = 0;
    for (const auto &list : neighbours_) links += list.size();
    const size_t max_per_link = std::max<size_t>(1, kMatchesPerWanted * wanted / std::max<size_t>(1, links / 2));
    const auto link_of = [&](const lensprof_match &m) { return edge_of(m.image[0], m.image[1]); };
    const std::vector<uint32_t> kept = thinned(matches, count, max_per_link, link_of, edge_numbers_);
    const auto pieces = static_cast<uint32_t>((kept.size() + kMatchesPerPiece - 1) / kMatchesPerPiece);
    std::vector<std::vector<MatchCandidate>> found(pieces);
    std::atomic<uint32_t> done{0};
    const auto work = [&](uint32_t piece) {
        for (size_t n = size_t{piece} * kMatchesPerPiece;
             n < std::min(kept.size(), (size_t{piece} + 1) * kMatchesPerPiece); n++) {
            MatchCandidate candidate;
            candidate.match = kept[n];
            if (flattest_place(matches[kept[n]], candidate)) found[piece].push_back(candidate);
        }
        done++;
    };
    run_parallel(pieces, work, [&] { return 0.95 * done / std::max(pieces, 1u); });
    std::vector<MatchCandidate> all;
    for (auto &list : found) std::move(list.begin(), list.end(), std::back_inserter(all));
    std::vector<lensprof_pair> pairs;
    for (const MatchCandidate &chosen : balanced_choice(std::move(all), wanted)) {
        if (match_of_pair) match_of_pair[pairs.size()] = chosen.match;
        pairs.push_back(chosen.pair);
    }
    report_done();
    return pairs;
}

}  // namespace lensprof
