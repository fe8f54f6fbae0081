// Tracks: points spread over what the pictures see, in every picture that sees them.
#include <algorithm>
#include <cmath>
#include <iterator>

#include <Eigen/Geometry>

#include "fit/base/constants.hpp"
#include "fit/sampling/balance.hpp"
#include "fit/sampling/sampler.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kPointsPerPiece = 64;  // points that a thread processes as a unit,
constexpr uint32_t kRound = 4096;         // and all threads together, before counting whether there are enough
constexpr uint32_t kMaxEmptyRounds = 64;  // rounds without any track
constexpr uint32_t kMaxRounds = 4096;
constexpr size_t kCandidatesPerWanted = 8;        // candidates per wanted point,
constexpr double kCells = 2.0;                    // and cells; each cell contributes the candidates of lowest gradient
constexpr double kBinSlack = 1.5;                 // an even spread has priority over a balance of radius and grey level
constexpr double kSteepest = 80.0 * kPi / 180.0;  // latitude at which a cylinder ends

}  // namespace

// The cap that contains every image's cone; the whole sphere if one is not known.
Sampler::Cone Sampler::cone_of_all() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    bool known = true;
    for (const Cone &cone : cones_) {
        known = known && cone.known;
        sum += Eigen::Map<const Eigen::Vector3d>(cone.axis);
    }
    Cone all{{0.0, 0.0, 1.0}, kPi, -1.0, known && sum.norm() > 1e-3};
    if (!all.known) return all;
    Eigen::Map<Eigen::Vector3d> axis(all.axis);
    axis = sum.normalized();
    all.reach = 0.0;
    for (const Cone &cone : cones_) {
        double cosine = std::clamp(axis.dot(Eigen::Map<const Eigen::Vector3d>(cone.axis)), -1.0, 1.0);
        all.reach = std::max(all.reach, std::acos(cosine) + cone.reach);
    }
    all.reach = std::min(all.reach, kPi);
    all.cosine = std::cos(all.reach);
    return all;
}

// Takes the point in one of the images that see it, in turn, and from there in the others, using the small rotations
// found between neighbours.
bool Sampler::find_track(const Aim &aim, uint32_t number, TrackCandidate &found) {
    std::vector<Visit> seen;
    double v[3], xy[2];
    unit_vector(aim.direction, v);
    for (uint32_t i = 0; i < views_.size(); i++) {
        const double *axis = cones_[i].axis;
        if (axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2] < cones_[i].cosine - kSlack) continue;
        if (lensprof_camera_project(&views_[i].image().camera, aim.direction[0], aim.direction[1], xy)
            && views_[i].holds(xy[0], xy[1]))
            seen.push_back({{xy[0], xy[1]}, i, 0, 0});
    }
    if (seen.size() < 2) return false;
    if (!overlaps_) overlaps_ = true;
    std::rotate(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(number % seen.size()), seen.end());
    const Visit anchor = seen[0];
    const double x = anchor.xy[0], y = anchor.xy[1];
    double gradient = 0.0;
    size_t measured = 0;
    End end;
    for (Visit &visit : seen) {
        bool other = visit.image != anchor.image;
        if (other && !are_neighbours(anchor.image, visit.image)) continue;
        bool good = (!other || correspond(anchor.image, visit.image, x, y, visit.xy))
                    && measure(visit.image, visit.xy[0], visit.xy[1], end);
        if (!good && !other) return false;
        if (!good || (other && !shows_same_scene(anchor.image, visit.image, x, y))) continue;
        visit.radius = end.radius, visit.grey = end.grey;
        gradient += end.patch.gradient;
        measured += *std::max_element(end.patch.value, end.patch.value + 3) < 1.0;
        found.visits.push_back(visit);
        if (found.visits.size() == kLongestTrack) break;
    }
    found.gradient = static_cast<float>(gradient / static_cast<double>(found.visits.size()));
    found.cell = aim.cell;
    return found.visits.size() > 1 && measured > 0;
}

// The rounds end at the same point for any number of threads.
std::vector<Sampler::TrackCandidate> Sampler::track_candidates(size_t wanted, const std::function<Aim(uint32_t)> &aim) {
    std::vector<TrackCandidate> all;
    const double before = shown_;  // of the progress
    for (uint32_t round = 0; round < kMaxRounds && all.size() < wanted && !(round > kMaxEmptyRounds && all.empty());
         round++) {
        std::vector<std::vector<TrackCandidate>> found(kRound / kPointsPerPiece);
        auto work = [&](uint32_t piece) {
            for (uint32_t k = piece * kPointsPerPiece; k < (piece + 1) * kPointsPerPiece; k++) {
                TrackCandidate candidate;
                if (find_track(aim(round * kRound + k), k, candidate)) found[piece].push_back(std::move(candidate));
            }
        };
        const double done = before + (0.95 - before) * static_cast<double>(all.size()) / static_cast<double>(wanted);
        run_parallel(static_cast<uint32_t>(found.size()), work, [=] { return done; });
        for (auto &list : found) std::move(list.begin(), list.end(), std::back_inserter(all));
    }
    return all;
}

// Removes the visits of images that the project has at a wrong position relative to the anchor's.
std::vector<Sampler::TrackCandidate> Sampler::in_place(std::vector<TrackCandidate> all) const {
    for (TrackCandidate &c : all) {
        auto is_out = [&, anchor = c.visits[0].image](const Visit &visit) {
            return visit.image != anchor && state_of(edge_of(anchor, visit.image)) == LENSPROF_LINK_CONTRADICTED;
        };
        c.visits.erase(std::remove_if(c.visits.begin(), c.visits.end(), is_out), c.visits.end());
    }
    auto is_short = [](const TrackCandidate &c) { return c.visits.size() < 2; };
    all.erase(std::remove_if(all.begin(), all.end(), is_short), all.end());
    return all;
}

std::vector<lensprof_observation> Sampler::observations_of(const std::vector<TrackCandidate> &chosen) {
    std::vector<std::vector<lensprof_observation>> tracks(chosen.size());
    auto work = [&](uint32_t n) {
        for (const Visit &visit : chosen[n].visits) {
            lensprof_observation o{n, visit.image, {visit.xy[0], visit.xy[1]}, {}};
            End end{};
            if (!measure(visit.image, o.xy[0], o.xy[1], end)) continue;
            std::copy(end.patch.value, end.patch.value + 3, o.value);
            tracks[n].push_back(o);
        }
    };
    run_parallel(static_cast<uint32_t>(chosen.size()), work, [] { return 0.97; });
    report_done();
    std::vector<lensprof_observation> all;
    for (const auto &track : tracks) all.insert(all.end(), track.begin(), track.end());
    return all;
}

std::vector<lensprof_observation> Sampler::balanced_tracks(uint32_t wanted) {
    patches_ = keep_white_ = true;
    register_neighbours();
    Random random{options_.seed};
    const double shift[2] = {random.next(), random.next()};
    const Cone cap = cone_of_all();
    const Eigen::Vector3d axis = Eigen::Map<const Eigen::Vector3d>(cap.axis), u = axis.unitOrthogonal(),
                          v = axis.cross(u);
    const auto side = static_cast<uint32_t>(std::sqrt(kCells * wanted)) + 1;
    // Equal areas: the cosine to the cap's axis and the angle about it, by Roberts' R2 sequence.
    auto aim = [&](uint32_t k) {
        double a = shift[0] + 0.7548776662466927 * (k + 1.0), b = shift[1] + 0.5698402909980532 * (k + 1.0);
        a -= std::floor(a), b -= std::floor(b);
        double cosine = 1.0 - a * (1.0 - cap.cosine), sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
        Eigen::Vector3d d = cosine * axis + sine * (std::cos(2.0 * kPi * b) * u + std::sin(2.0 * kPi * b) * v);
        // Lambert's azimuthal projection has equal areas, too, and its squares contain nearby places.
        auto line = [&](double x) { return static_cast<uint32_t>((0.5 + 0.4999 * std::sqrt(a) * x) * side); };
        Aim result{{}, line(std::cos(2.0 * kPi * b)) * side + line(std::sin(2.0 * kPi * b))};
        direction_of_vector(d.data(), result.direction);
        return result;
    };
    std::vector<TrackCandidate> all = in_place(track_candidates(kCandidatesPerWanted * wanted, aim));
    std::sort(all.begin(), all.end(), [](const TrackCandidate &a, const TrackCandidate &b) {
        return a.cell != b.cell ? a.cell < b.cell : a.gradient < b.gradient;
    });
    std::vector<uint32_t> rank(all.size(), 0);  // within a cell: those of lowest gradient are first
    for (size_t n = 1; n < all.size(); n++) rank[n] = all[n].cell == all[n - 1].cell ? rank[n - 1] + 1 : 0;
    size_t ends = 0;
    for (const TrackCandidate &c : all) ends += c.visits.size();
    double mean = static_cast<double>(ends) / static_cast<double>(std::max<size_t>(all.size(), 1));
    auto chosen = balance(
        all.size(), wanted, kBinSlack * mean * wanted, side * side, [&](uint32_t i) { return rank[i]; },
        [&](uint32_t i) { return all[i].cell; },
        [&](uint32_t i, auto use) {
            for (const Visit &visit : all[i].visits) use(visit.radius, visit.grey);
        });
    std::vector<TrackCandidate> best;
    for (uint32_t index : chosen) best.push_back(all[index]);
    for (const TrackCandidate &c : best)
        for (size_t n = 1; n < c.visits.size(); n++) likenesses_[edge_of(c.visits[0].image, c.visits[n].image)].pairs++;
    return observations_of(best);
}

std::vector<lensprof_observation> Sampler::paper_tracks(uint32_t wanted) {
    patches_ = false, keep_white_ = true;
    // Height on the cylinder about the panorama's axis, as far as the pictures reach.
    double highest = 0.0;
    for (const Cone &cone : cones_) {
        double latitude = cone.known ? std::abs(std::asin(std::clamp(cone.axis[1], -1.0, 1.0))) + cone.reach : kPi;
        highest = std::max(highest, std::tan(std::min(latitude, kSteepest)));
    }
    auto aim = [&](uint32_t k) {
        Random random{options_.seed + (uint64_t{k} << 32)};
        double longitude = 2.0 * kPi * (random.next() - 0.5), height = highest * (2.0 * random.next() - 1.0);
        return Aim{{longitude, std::atan(height)}, 0};
    };
    std::vector<TrackCandidate> all = track_candidates(wanted, aim);
    all.resize(std::min<size_t>(all.size(), wanted));
    return observations_of(all);
}

}  // namespace lensprof
