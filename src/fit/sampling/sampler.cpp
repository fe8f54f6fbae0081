#include "fit/sampling/sampler.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "fit/base/parallel.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kPlacesPerPiece = 32;  // places of one image that a thread processes as a unit
constexpr uint32_t kPaperRound = 8192;
constexpr double kWidestCone =
    1.5;  // radians: beyond it, the border of a frame may be farther from the axis than its samples
constexpr double kAlike = 0.5;         // correlation of places that may show the same,
constexpr double kClearlyAlike = 0.8;  // and of those that clearly do
// Shares of the places with texture. Alike: .05 to .31 if a project is wrong, .43 and more in real sequences and with
// 30 % of random pixels. If things moved on 44 % of the places, it can be .22, too, but .08 and more are clearly alike,
// 3.2 times as many as among displaced places; with a wrong project, up to .1 are, 2.4 times.
constexpr double kMinAlike = 0.4, kMinClearlyAlike = 0.05, kAboveChance = 2.8;
constexpr double kDisplacement = 12.0;  // coarse pixels
constexpr uint32_t kMinTextured = 20;
constexpr double kMostlySmooth = 0.25;  // of the places with texture: smooth places tolerate a shift of a few pixels
constexpr size_t kMaxNeighbours = 8;    // of an image that are registered, those with the largest overlap
constexpr double kShareOfRegistration = 0.5;  // of the progress that is shown
constexpr size_t kMaxRefused = 4;             // pairs of places per wanted candidate, before the search ends

double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double angle_between(const double a[3], const double b[3]) { return std::acos(std::clamp(dot(a, b), -1.0, 1.0)); }

// Unit vector of a pixel's direction; false if it has no direction.
bool direction_of(const lensprof_camera &camera, double x, double y, double v[3]) {
    double direction[2];
    if (!lensprof_camera_unproject(&camera, x, y, direction)) return false;
    unit_vector(direction, v);
    return true;
}

// How many of a few places of the first image the second sees.
int overlap_of(const lensprof_camera &first, const lensprof_camera &second) {
    constexpr int columns = 8, rows = 6;
    int seen = 0;
    for (int k = 0; k < columns * rows; k++)
        seen += sees(first, second, (k % columns + 0.5) / columns, (k / columns + 0.5) / rows);
    return seen;
}

// Moves the elements of the lists, in order, into one list.
template <class T>
void append(std::vector<std::vector<T>> &lists, std::vector<T> &all) {
    for (auto &list : lists) {
        all.insert(all.end(), list.begin(), list.end());
        list = {};
    }
}

}  // namespace

Sampler::Sampler(const lensprof_sample_options &options, const lensprof_sample_image *images, uint32_t count)
    : options_(options) {
    for (uint32_t i = 0; i < count; i++) views_.emplace_back(images[i]);
    find_neighbours();
}

// Cones are not valid for translated cameras, or for frames that reach beyond the projection.
Sampler::Cone Sampler::cone_of(const lensprof_camera &camera) {
    Cone cone{};
    cone.known = !camera.translation[0] && !camera.translation[1] && !camera.translation[2]
                 && direction_of(camera, 0.5 * (camera.width - 1.0), 0.5 * (camera.height - 1.0), cone.axis);
    for (int k = 0; k < 16 && cone.known; k++) {
        double x = (k % 4) / 3.0 * (camera.width - 1.0), y = (k / 4) / 3.0 * (camera.height - 1.0), v[3];
        cone.known = direction_of(camera, x, y, v);
        if (cone.known) cone.reach = std::max(cone.reach, 1.05 * angle_between(cone.axis, v));
    }
    cone.known = cone.known && cone.reach < kWidestCone;
    cone.cosine = cone.known ? std::cos(std::min(cone.reach, std::acos(-1.0))) : -2.0;
    return cone;
}

// Images whose view cones touch; an image without a cone is a neighbour of all images.
void Sampler::find_neighbours() {
    for (const View &view : views_) cones_.push_back(cone_of(view.image().camera));
    neighbours_.resize(views_.size());
    for (uint32_t i = 0; i < views_.size(); i++)
        for (uint32_t j = i + 1; j < views_.size(); j++) {
            const Cone &a = cones_[i], &b = cones_[j];
            if (a.known && b.known && angle_between(a.axis, b.axis) > a.reach + b.reach) continue;
            neighbours_[i].push_back(j);
            neighbours_[j].push_back(i);
        }
    number_edges();
}

void Sampler::number_edges() {
    for (const auto &list : neighbours_) {
        first_edge_.push_back(edge_numbers_);
        edge_numbers_ += static_cast<uint32_t>(list.size());
    }
}

bool Sampler::are_neighbours(uint32_t i, uint32_t j) const {
    return std::binary_search(neighbours_[i].begin(), neighbours_[i].end(), j);
}

// Number of the pair of images, independent of their order.
uint32_t Sampler::edge_of(uint32_t i, uint32_t j) const {
    auto [low, high] = std::minmax(i, j);
    const auto &list = neighbours_[low];
    auto place = std::lower_bound(list.begin(), list.end(), high) - list.begin();
    return first_edge_[low] + static_cast<uint32_t>(place);
}

// Runs work on all threads; reports the fraction done() to the caller as long as it rises.
void Sampler::run_parallel(uint32_t count, const std::function<void(uint32_t)> &work,
                           const std::function<double()> &done) {
    auto stop = [&] {
        shown_ = std::max(shown_, std::min(done(), 1.0));
        return options_.progress && options_.progress(shown_, options_.progress_user) != 0;
    };
    if (!for_each_parallel(count, options_.threads, work, stop)) throw Cancelled();
}

void Sampler::read_grey_levels() {
    const auto count = static_cast<uint32_t>(views_.size());
    grey_.resize(count);
    const Light light(options_.response, options_.vignetting);
    run_parallel(
        count, [&](uint32_t i) { grey_[i] = std::make_unique<GreyLevels>(views_[i], light); }, [] { return 0.0; });
}

void Sampler::report_done() {
    run_parallel(
        1, [](uint32_t) {}, [] { return 1.0; });
}

// Measures the error of the project between neighbours from the pictures. The project of a static camera is not off:
// pictures that are mostly white, or mostly black, would only seem to show an error.
void Sampler::register_neighbours() {
    corrections_.assign(edge_numbers_, {});
    likenesses_ = std::vector<Likenesses>(edge_numbers_);
    if (options_.sampling == LENSPROF_SAMPLING_BRACKET) return;
    struct Edge {
        uint32_t i, j;
        int overlap;
    };
    read_grey_levels();
    const auto count = static_cast<uint32_t>(views_.size());
    std::vector<Edge> edges;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j : neighbours_[i])
            if (j > i) edges.push_back({i, j, 0});
    auto size = static_cast<uint32_t>(edges.size());
    auto camera = [&](uint32_t i) -> const lensprof_camera & { return views_[i].image().camera; };
    run_parallel(
        size, [&](uint32_t e) { edges[e].overlap = overlap_of(camera(edges[e].i), camera(edges[e].j)); },
        [] { return 0.0; });
    std::stable_sort(edges.begin(), edges.end(), [](const Edge &a, const Edge &b) { return a.overlap > b.overlap; });
    std::vector<size_t> registered(count, 0);
    auto is_left_out = [&](const Edge &e) {
        bool wanted = e.overlap > 0 && std::min(registered[e.i], registered[e.j]) < kMaxNeighbours;
        if (wanted) registered[e.i]++, registered[e.j]++;
        return !wanted;
    };
    edges.erase(std::remove_if(edges.begin(), edges.end(), is_left_out), edges.end());
    std::atomic<uint32_t> done{0};
    auto work = [&](uint32_t e) {
        auto [i, j, overlap] = edges[e];
        corrections_[edge_of(i, j)] = registration(camera(i), *grey_[i], camera(j), *grey_[j]);
        done++;
    };
    run_parallel(static_cast<uint32_t>(edges.size()), work,
                 [&] { return kShareOfRegistration * done / std::max<size_t>(edges.size(), 1); });
}

const Correction &Sampler::correction(uint32_t i, uint32_t j) const {
    static const Correction no_correction;
    return patches_ ? corrections_[edge_of(i, j)] : no_correction;
}

// The place at which image j sees what image i sees at (x, y); false if it does not.
bool Sampler::correspond(uint32_t i, uint32_t j, double x, double y, double xy[2]) const {
    return place_of(views_[i].image().camera, views_[j].image().camera, correction(i, j),
                    i < j ? Way::forward : Way::back, x, y, xy)
           && views_[j].holds(xy[0], xy[1]);
}

// Whether both show the same there, as far as texture shows. Single points, as the paper samples them, are not checked.
bool Sampler::shows_same_scene(uint32_t i, uint32_t j, double x, double y) {
    Sight expected;
    if (!patches_ || options_.sampling == LENSPROF_SAMPLING_BRACKET) return true;
    if (!sight(views_[i].image().camera, views_[j].image().camera, correction(i, j), i < j ? Way::forward : Way::back,
               x, y, expected))
        return false;
    return is_alike(i, x, y, j, expected);
}

// The same for a place and its expected counterpart.
bool Sampler::is_alike(uint32_t i, double x, double y, uint32_t j, Sight expected) {
    Likenesses &edge = likenesses_[edge_of(i, j)];
    edge.seen++;
    std::optional<double> correlation = likeness(*grey_[i], x, y, *grey_[j], expected);
    if (!correlation) return wide_likeness(*grey_[i], x, y, *grey_[j], expected).value_or(1.0) > kAlike;
    edge.textured++;
    if (*correlation > kAlike) edge.alike++;
    if (*correlation > kClearlyAlike) edge.clearly_alike++;
    const auto side = static_cast<int>(std::abs(x) + std::abs(y));  // alternates from place to place
    (side % 2 ? expected.x : expected.y) += (side / 2 % 2 ? kDisplacement : -kDisplacement) * grey_[j]->level[0].pixel;
    std::optional<double> displaced = likeness(*grey_[i], x, y, *grey_[j], expected);
    if (displaced) edge.displaced++;
    if (displaced && *displaced > kClearlyAlike) edge.chance++;
    return *correlation > kAlike;
}

// If barely more places show the same than displaced places do, the project has one of the two images at a wrong
// position: places that agree do so by chance. This does not apply if few places have texture: a project that is off by
// some pixels is wrong only there, and those places are left out one by one.
lensprof_link_state Sampler::state_of(uint32_t number) const {
    const Likenesses &edge = likenesses_[number];
    const double clearly_alike = edge.clearly_alike, textured = edge.textured, chance = edge.chance,
                 displaced = edge.displaced;
    const lensprof_link_state without_texture = by_matches_ ? LENSPROF_LINK_VERIFIED : LENSPROF_LINK_UNVERIFIED;
    if (textured < kMinTextured) return without_texture;
    if (edge.alike > kMinAlike * textured) return LENSPROF_LINK_VERIFIED;
    if (clearly_alike > kMinClearlyAlike * textured && clearly_alike * displaced > kAboveChance * chance * textured)
        return LENSPROF_LINK_VERIFIED;
    return textured < kMostlySmooth * edge.seen ? without_texture : LENSPROF_LINK_CONTRADICTED;
}

std::vector<lensprof_link> Sampler::links() const {
    std::vector<lensprof_link> links;
    for (uint32_t i = 0; i < views_.size() && !likenesses_.empty(); i++)
        for (uint32_t j : neighbours_[i]) {
            const uint32_t number = edge_of(i, j);
            if (j < i || (likenesses_[number].seen == 0 && likenesses_[number].pairs == 0)) continue;
            links.push_back({{i, j}, static_cast<uint32_t>(state_of(number)), likenesses_[number].pairs});
        }
    return links;
}

bool Sampler::measure(uint32_t i, double x, double y, End &end) const {
    const View &view = views_[i];
    if (!(patches_ ? view.patch(x, y, keep_white_, end.patch) : view.point(x, y, keep_white_, end.patch))) return false;
    const double mean = (end.patch.value[0] + end.patch.value[1] + end.patch.value[2]) / 3.0;
    const lensprof_vignetting centred{};
    const auto &camera = view.image().camera;
    double r = std::sqrt(lensprof_vignetting_r2(&centred, camera.width, camera.height, x, y, nullptr));
    end.radius = static_cast<uint8_t>(std::min(static_cast<int>(r * kRadiusBins), kRadiusBins - 1));
    end.grey = static_cast<uint8_t>(std::min(static_cast<int>(mean * kGreyBins), kGreyBins - 1));
    return true;
}

// Finds the candidates between a place of image i and the other images that see it.
void Sampler::look(uint32_t i, double x, double y, const uint32_t *others, size_t count,
                   std::vector<Candidate> &found) {
    double v[3], xy[2];
    if (!views_[i].holds(x, y) || !direction_of(views_[i].image().camera, x, y, v)) return;
    End first_end, second_end;
    bool measured = false;
    for (size_t n = 0; n < count; n++) {
        const uint32_t j = others[n];
        if (dot(cones_[j].axis, v) < cones_[j].cosine - kSlack || !correspond(i, j, x, y, xy)) continue;
        if (!overlaps_) overlaps_ = true;
        if (!measured && !measure(i, x, y, first_end)) return;
        measured = true;
        if (!measure(j, xy[0], xy[1], second_end)) continue;
        if (!shows_same_scene(i, j, x, y)) {
            refused_++;
            continue;
        }
        found.push_back({x,
                         y,
                         {i, j},
                         static_cast<float>(first_end.patch.gradient + second_end.patch.gradient),
                         {first_end.radius, second_end.radius},
                         {first_end.grey, second_end.grey}});
    }
}

// Candidates spread evenly over every image (a low-discrepancy sequence), until there are enough or the overlaps are
// exhausted. The rounds end at the same candidate for any number of threads.
std::vector<Sampler::Candidate> Sampler::candidates(size_t wanted) {
    std::vector<Candidate> all;
    Random random{options_.seed};
    const double shift[2] = {random.next(), random.next()};
    size_t sights = 0;  // ways from image to image: a round looks `chunk` times along each
    for (const auto &list : neighbours_) sights += list.size();
    auto chunk = static_cast<uint32_t>(std::clamp<size_t>(4 * wanted / std::max<size_t>(sights, 1), 4, 256));
    const uint32_t max_rounds = 102400 / chunk, max_empty_rounds = 2560 / chunk,
                   pieces = (chunk + kPlacesPerPiece - 1) / kPlacesPerPiece;
    const double before = shown_;  // of the progress
    for (uint32_t round = 0; round < max_rounds && all.size() < wanted && refused_ < kMaxRefused * wanted
                             && !(round > max_empty_rounds && all.empty());
         round++) {
        std::vector<std::vector<Candidate>> found(views_.size() * pieces);
        std::atomic<size_t> count{all.size()};
        auto work = [&](uint32_t n) {
            const uint32_t i = n / pieces, first = n % pieces * kPlacesPerPiece,
                           end = std::min(first + kPlacesPerPiece, chunk);
            const auto &camera = views_[i].image().camera;
            for (uint32_t k = round * chunk + first; k < round * chunk + end; k++) {
                // Roberts' R2 sequence: the plane's generalised golden ratio.
                double a = shift[0] + 0.7548776662466927 * (k + 1.0), b = shift[1] + 0.5698402909980532 * (k + 1.0);
                double x = (a - std::floor(a)) * camera.width - 0.5, y = (b - std::floor(b)) * camera.height - 0.5;
                look(i, x, y, neighbours_[i].data(), neighbours_[i].size(), found[n]);
            }
            count += found[n].size();
        };
        run_parallel(static_cast<uint32_t>(found.size()), work, [&] {
            return before + (0.95 - before) * static_cast<double>(count) / static_cast<double>(wanted);
        });
        append(found, all);
    }
    return all;
}

std::vector<lensprof_pair> Sampler::pairs_of(const std::vector<Candidate> &chosen) {
    std::vector<lensprof_pair> pairs(chosen.size());
    const auto pieces = static_cast<uint32_t>((chosen.size() + kPlacesPerPiece - 1) / kPlacesPerPiece);
    auto work = [&](uint32_t piece) {
        for (size_t n = size_t{piece} * kPlacesPerPiece;
             n < std::min(chosen.size(), (size_t{piece} + 1) * kPlacesPerPiece); n++) {
            const Candidate &c = chosen[n];
            lensprof_pair &pair = pairs[n];
            pair = {{c.image[0], c.image[1]}, {{c.x, c.y}, {0.0, 0.0}}, {}};
            End end{};
            bool good = correspond(c.image[0], c.image[1], c.x, c.y, pair.xy[1]);
            for (int side = 0; side < 2 && good; side++) {
                good = measure(c.image[side], pair.xy[side][0], pair.xy[side][1], end);
                std::copy(end.patch.value, end.patch.value + 3, pair.value[side]);
            }
        }
    };
    run_parallel(pieces, work, [] { return 0.97; });
    report_done();
    return pairs;
}

std::vector<lensprof_pair> Sampler::balanced(uint32_t wanted) {
    patches_ = true;
    register_neighbours();
    return pairs_of(balanced_choice(candidates(8 * static_cast<size_t>(wanted)), wanted));
}

// A random place of a random image, and one of its neighbours; the image itself if there are no neighbours.
Sampler::Look Sampler::draw(Random &random) const {
    auto i = static_cast<uint32_t>(random.next() * static_cast<double>(views_.size()));
    const auto &camera = views_[i].image().camera;
    double x = random.next() * camera.width - 0.5, y = random.next() * camera.height - 0.5, pick = random.next();
    const auto &list = neighbours_[i];
    return {x, y, {i, list.empty() ? i : list[static_cast<size_t>(pick * static_cast<double>(list.size()))]}};
}

std::vector<lensprof_pair> Sampler::paper(uint32_t wanted) {
    patches_ = false;
    Random random{options_.seed};
    std::vector<Candidate> all, best;
    const size_t enough = 5 * static_cast<size_t>(wanted), max_trials = 200 * static_cast<size_t>(wanted) + 10000;
    for (size_t trials = 0; trials < max_trials && all.size() < enough; trials += kPaperRound) {
        std::vector<Look> looks(std::min<size_t>(kPaperRound, max_trials - trials));
        for (Look &l : looks) l = draw(random);
        std::vector<std::vector<Candidate>> found((looks.size() + kPlacesPerPiece - 1) / kPlacesPerPiece);
        auto work = [&](uint32_t n) {
            for (size_t k = size_t{n} * kPlacesPerPiece; k < std::min(looks.size(), (size_t{n} + 1) * kPlacesPerPiece);
                 k++) {
                const Look &l = looks[k];
                look(l.image[0], l.x, l.y, &l.image[1], l.image[1] == l.image[0] ? 0 : 1, found[n]);
            }
        };
        double done = 0.95 * static_cast<double>(all.size()) / static_cast<double>(enough);
        run_parallel(static_cast<uint32_t>(found.size()), work, [=] { return done; });
        append(found, all);
    }
    all.resize(std::min(all.size(), enough));
    for (uint8_t bin = 0; bin < kRadiusBins; bin++) {
        std::vector<Candidate> bin_candidates;
        std::copy_if(all.begin(), all.end(), std::back_inserter(bin_candidates),
                     [=](const Candidate &c) { return c.radius[0] == bin; });
        std::stable_sort(bin_candidates.begin(), bin_candidates.end(),
                         [](const Candidate &a, const Candidate &b) { return a.gradient < b.gradient; });
        bin_candidates.resize(std::min<size_t>(bin_candidates.size(), std::max(1u, wanted / kRadiusBins)));
        bin_candidates.resize(std::min(bin_candidates.size(), wanted - best.size()));
        best.insert(best.end(), bin_candidates.begin(), bin_candidates.end());
    }
    return pairs_of(best);
}

}  // namespace lensprof
