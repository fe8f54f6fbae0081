#include "photo/reconstruction/match_choice.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <queue>
#include <set>
#include <tuple>

#include "fit/base/joined_sets.hpp"
#include "fit/base/mixed_bits.hpp"
#include "photo/reconstruction/link_order.hpp"

namespace lensprof {
namespace {

constexpr double kUsualAngle = 0.2618;  // 15 degrees, in radians
constexpr double kUsualShare = 0.05;    // share of common points whose views are downweighted as much
constexpr size_t kLongTrack = 12;       // an observation of a longer track is paired only with some of the others:
constexpr size_t kFewImages = 300;      // whose links are all kept; of more
constexpr uint32_t kMaxLinks = 20;      // the strongest links of an image, and a few
constexpr size_t kNext = 3, kFar = 6;   // the next ones in image order, and others

// A pseudo-random number in (0, 1] for another number.
double fraction_of(uint64_t value) {
    return (static_cast<double>(mixed_bits(value + splitmix_step) >> 11) + 1.0) / 9007199254740992.0;
}

// Points that two images have in common, as a share of the points of either.
class Shares {
public:
    explicit Shares(const Reconstruction &r) : points_(r.images.size()), common_(common_points(r)) {
        for (const TrackObservation &observation : r.observations) points_[observation.image]++;
    }
    double overlap(uint32_t i, uint32_t j) const {
        const auto found = common_.find(std::minmax(i, j));
        const uint32_t least = std::min(points_[i], points_[j]);
        return found == common_.end() || !least ? 0.0 : std::min(1.0, found->second / double(least));
    }

private:
    std::vector<uint32_t> points_;
    const LinkWeights common_;
};

// Angle between two views of a point, radians; empty without poses.
std::optional<double> view_angle(const Reconstruction &r, const TrackObservation &a, const TrackObservation &b) {
    const ReconstructionImage &i = r.images[a.image], &j = r.images[b.image];
    if (!i.has_centre || !j.has_centre || r.points.empty() || !is_finite(r.points[a.point])) return {};
    double dot = 0.0, square_a = 0.0, square_b = 0.0;
    for (size_t d = 0; d < 3; d++) {
        const double x = i.centre[d] - r.points[a.point][d], y = j.centre[d] - r.points[a.point][d];
        dot += x * y, square_a += x * x, square_b += y * y;
    }
    const double cosine = dot / (std::sqrt(square_a) * std::sqrt(square_b));
    if (!std::isfinite(cosine)) return {};  // at one position, or too far
    return std::acos(std::clamp(cosine, -1.0, 1.0));
}

// Distance of two views of a point, where 1 is usual.
class ViewDistance {
public:
    explicit ViewDistance(const Reconstruction &r) : r_(r), shares_(r) {}

    double distance(const ObservationPair &pair) const {
        const TrackObservation &a = r_.observations[pair.first], &b = r_.observations[pair.second];
        if (const auto angle = view_angle(r_, a, b)) return *angle / kUsualAngle;
        return kUsualShare / std::max(1e-6, shares_.overlap(a.image, b.image));
    }

private:
    const Reconstruction &r_;
    const Shares shares_;
};

// The pairs of each image with the highest rank.
class Choice {
public:
    Choice(size_t images, size_t max_pairs) : best_(images), most_(max_pairs) {}

    void offer(const ObservationPair &pair, uint32_t i, uint32_t j, double order) {
        for (const uint32_t image : {i, j}) {
            auto &queue = best_[image];
            if (queue.size() == most_ && !(order < queue.top().order)) continue;
            queue.push({order, pair});
            if (queue.size() > most_) queue.pop();
        }
    }
    std::vector<ObservationPair> taken() {
        std::vector<ObservationPair> all;
        for (auto &queue : best_)
            for (; !queue.empty(); queue.pop()) all.push_back(queue.top().pair);
        return all;
    }

private:
    struct Offer {
        double order;
        ObservationPair pair;
        bool operator<(const Offer &other) const {
            return std::tie(order, pair.first, pair.second)
                   < std::tie(other.order, other.pair.first, other.pair.second);
        }
    };
    std::vector<std::priority_queue<Offer>> best_;
    size_t most_;
};

// Calls offer(a, b) for pairs of a track's observations from `first` to `last`: all of them, or some for a long track.
template <class Offer>
void pair_track(size_t first, size_t last, const Offer &offer) {
    const size_t count = last - first;
    for (size_t a = first; a < last; a++) {
        if (count <= kLongTrack) {
            for (size_t b = a + 1; b < last; b++) offer(a, b);
            continue;
        }
        for (size_t n = 1; n <= kNext && a + n < last; n++) offer(a, a + n);
        for (size_t n = 0; n < kFar; n++) {
            const auto b = first + static_cast<size_t>(fraction_of(a * kFar + n) * double(count - 1));
            if (b > a + kNext || b + kNext < a) offer(std::min(a, b), std::max(a, b));
        }
    }
}

using Map = std::array<std::array<double, 2>, 2>;

// The map between the surroundings of two features: B A^-1; empty if a shape is unknown or degenerate.
std::optional<Map> map_of_shapes(const TrackObservation &from, const TrackObservation &to) {
    const auto &a = from.shape, &b = to.shape;
    const double determinant = double(a[0][0]) * a[1][1] - double(a[0][1]) * a[1][0];
    if (!(determinant > 0.0)) return {};
    const double inverse[2][2] = {{a[1][1] / determinant, -a[0][1] / determinant},
                                  {-a[1][0] / determinant, a[0][0] / determinant}};
    Map map;
    for (size_t row = 0; row < 2; row++)
        for (size_t column = 0; column < 2; column++)
            map[row][column] = b[row][0] * inverse[0][column] + b[row][1] * inverse[1][column];
    const double scale = map[0][0] * map[1][1] - map[0][1] * map[1][0];
    return scale > 0.0 && std::isfinite(scale) ? std::optional<Map>(map) : std::nullopt;
}

// The links kept if images have many: the strongest per image, and those needed to connect all images. Images linked to
// hundreds of others make the equations of the fit dense.
std::set<uint32_t> links_to_keep(const std::vector<std::pair<uint32_t, uint32_t>> &links,
                                 const std::vector<double> &weights, size_t images) {
    std::vector<uint32_t> order(links.size()), kept_of(images);
    JoinedSets joined(images);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return weights[a] > weights[b]; });
    std::set<uint32_t> kept;
    for (const uint32_t link : order) {
        const auto [i, j] = links[link];
        if (joined.of(i) == joined.of(j) && kept_of[i] >= kMaxLinks && kept_of[j] >= kMaxLinks) continue;
        joined.join(i, j);
        kept_of[i]++, kept_of[j]++;
        kept.insert(link);
    }
    return kept;
}

// Keeps the pairs of these links; `pairs` are sorted by images.
void thin_links(const Reconstruction &r, const ViewDistance &distance, std::vector<ObservationPair> &pairs) {
    if (r.images.size() <= kFewImages) return;
    std::vector<std::pair<uint32_t, uint32_t>> links;
    std::vector<double> weights;
    std::vector<uint32_t> link_of_pair;
    for (const ObservationPair &pair : pairs) {
        const std::pair<uint32_t, uint32_t> link{r.observations[pair.first].image, r.observations[pair.second].image};
        if (links.empty() || links.back() != link) links.push_back(link), weights.push_back(0.0);
        const double view_distance = distance.distance(pair);
        weights.back() += 1.0 / (1.0 + view_distance * view_distance);
        link_of_pair.push_back(static_cast<uint32_t>(links.size() - 1));
    }
    const std::set<uint32_t> kept = links_to_keep(links, weights, r.images.size());
    size_t count = 0;
    for (size_t p = 0; p < pairs.size(); p++)
        if (kept.count(link_of_pair[p])) pairs[count++] = pairs[p];
    pairs.resize(count);
}

}  // namespace

std::vector<ObservationPair> choose_pairs(const Reconstruction &r, uint32_t of_image, uint32_t seed) {
    const ViewDistance distance(r);
    const auto &all = r.observations;
    const auto order_of = [&](const ObservationPair &pair) {
        const double view_distance = distance.distance(pair);
        const double chance = fraction_of((uint64_t{seed} << 32) + all[pair.first].point);  // of all pairs of a point
        return -std::log(chance)
               * (1.0
                  + view_distance * view_distance);  // by weights, without replacement (Efraimidis and Spirakis 2006)
    };
    Choice choice(r.images.size(), std::max(1u, of_image));
    for (size_t first = 0, last = 0; first < all.size(); first = last) {
        for (last = first; last < all.size() && all[last].point == all[first].point;) last++;
        pair_track(first, last, [&](size_t a, size_t b) {
            const ObservationPair pair{static_cast<uint32_t>(a), static_cast<uint32_t>(b)};
            choice.offer(pair, all[a].image, all[b].image, order_of(pair));
        });
    }
    std::vector<ObservationPair> taken = choice.taken();
    const auto key = [&](const ObservationPair &p) {
        return std::tuple(all[p.first].image, all[p.second].image, p.first, p.second);
    };
    std::sort(taken.begin(), taken.end(), [&](const auto &a, const auto &b) { return key(a) < key(b); });
    const auto is_same = [&](const auto &a, const auto &b) { return key(a) == key(b); };
    taken.erase(std::unique(taken.begin(), taken.end(), is_same), taken.end());
    thin_links(r, distance, taken);
    return taken;
}

std::map<std::pair<uint32_t, uint32_t>, double> view_distances(const Reconstruction &r,
                                                               const std::vector<ObservationPair> &pairs) {
    const ViewDistance distance(r);
    std::map<std::pair<uint32_t, uint32_t>, double> sums, counts, means;
    for (const ObservationPair &pair : pairs) {
        const auto link = std::minmax(r.observations[pair.first].image, r.observations[pair.second].image);
        sums[link] += distance.distance(pair), counts[link]++;
    }
    for (const auto &[link, sum] : sums) means[link] = sum / counts[link];
    return means;
}

std::vector<lensprof_match> matches_of(const Reconstruction &r, const std::vector<ObservationPair> &pairs) {
    std::vector<lensprof_match> matches;
    for (const ObservationPair &pair : pairs) {
        const TrackObservation &from = r.observations[pair.first], &to = r.observations[pair.second];
        lensprof_match match{{from.image, to.image}, {{from.xy[0], from.xy[1]}, {to.xy[0], to.xy[1]}}, {}};
        if (r.has_rotations)
            if (const auto map = map_of_shapes(from, to))
                for (size_t row = 0; row < 2; row++) std::copy((*map)[row].begin(), (*map)[row].end(), match.map[row]);
        matches.push_back(match);
    }
    return matches;
}

}  // namespace lensprof
