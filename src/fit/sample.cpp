// Finding correspondences: candidates from image to image through the geometry, then a balanced choice.
#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <numeric>
#include <vector>

#include "fail.hpp"
#include "view.hpp"

using namespace lensprof;

namespace {

constexpr int kRadiusBins = 10, kGreyBins = 10;
constexpr uint32_t kLargestCount = 1u << 24;

struct Candidate {
    lensprof_pair pair;
    double gradient;   // both ends together
    int radius[2], grey[2];
};

// splitmix64: a fixed sequence from a seed.
struct Random {
    uint64_t state;
    double next() {
        uint64_t x = state += 0x9e3779b97f4a7c15ull;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
        return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-53;
    }
};

class Sampler {
public:
    Sampler(const lensprof_sample_options &options, const lensprof_sample_image *images, uint32_t count)
        : options_(options) {
        for (uint32_t i = 0; i < count; i++) views_.emplace_back(images[i]);
        find_neighbours();
    }

    std::vector<lensprof_pair> balanced(uint32_t wanted);
    std::vector<lensprof_pair> paper(uint32_t wanted);
    bool overlaps() const { return overlaps_; }

private:
    void find_neighbours();
    bool sees(uint32_t j, const double direction[2], double xy[2]) const;
    bool measure(uint32_t i, uint32_t j, double x, double y, const double xy[2], bool patches, Candidate &out) const;
    std::vector<Candidate> candidates(size_t wanted);

    const lensprof_sample_options &options_;
    std::vector<View> views_;
    std::vector<std::vector<uint32_t>> neighbours_;
    bool overlaps_ = false;
};

// Unit vector of a pixel's direction; false when it has none.
bool direction_of(const lensprof_camera &camera, double x, double y, double d[3]) {
    double direction[2];
    if (!lensprof_camera_unproject(&camera, x, y, direction)) return false;
    d[0] = std::cos(direction[1]) * std::sin(direction[0]);
    d[1] = std::sin(direction[1]);
    d[2] = std::cos(direction[1]) * std::cos(direction[0]);
    return true;
}

// Images whose view cones touch. Cones do not tell anything about translated cameras or frames that reach beyond the
// projection: those are everybody's neighbours.
void Sampler::find_neighbours() {
    struct Cone {
        double axis[3], reach;
        bool known;
    };
    std::vector<Cone> cones;
    for (const View &view : views_) {
        const auto &camera = view.image().camera;
        Cone cone{};
        cone.known = !camera.translation[0] && !camera.translation[1] && !camera.translation[2]
            && direction_of(camera, 0.5 * (camera.width - 1.0), 0.5 * (camera.height - 1.0), cone.axis);
        for (int k = 0; k < 16 && cone.known; k++) {
            double x = (k % 4) / 3.0 * (camera.width - 1.0), y = (k / 4) / 3.0 * (camera.height - 1.0), d[3];
            cone.known = direction_of(camera, x, y, d);
            double cosine = cone.axis[0] * d[0] + cone.axis[1] * d[1] + cone.axis[2] * d[2];
            cone.reach = std::max(cone.reach, std::acos(std::clamp(cosine, -1.0, 1.0)));
        }
        cones.push_back(cone);
    }
    neighbours_.resize(views_.size());
    for (uint32_t i = 0; i < views_.size(); i++)
        for (uint32_t j = 0; j < views_.size(); j++) {
            const Cone &a = cones[i], &b = cones[j];
            double cosine = a.axis[0] * b.axis[0] + a.axis[1] * b.axis[1] + a.axis[2] * b.axis[2];
            bool apart = a.known && b.known && std::acos(std::clamp(cosine, -1.0, 1.0)) > 1.05 * (a.reach + b.reach);
            if (i != j && !apart) neighbours_[i].push_back(j);
        }
}

// Where image j sees a direction.
bool Sampler::sees(uint32_t j, const double direction[2], double xy[2]) const {
    return lensprof_camera_project(&views_[j].image().camera, direction[0], direction[1], xy)
        && views_[j].holds(xy[0], xy[1]);
}

bool Sampler::measure(uint32_t i, uint32_t j, double x, double y, const double xy[2], bool patches,
                      Candidate &out) const {
    const uint32_t image[2] = {i, j};
    const double position[2][2] = {{x, y}, {xy[0], xy[1]}};
    out.gradient = 0.0;
    for (int side = 0; side < 2; side++) {
        const View &view = views_[image[side]];
        Patch patch;
        double px = position[side][0], py = position[side][1];
        if (!(patches ? view.patch(px, py, patch) : view.point(px, py, patch))) return false;
        int channels = view.channels();
        double mean = 0.0;
        for (int c = 0; c < 3; c++) {
            out.pair.value[side][c] = patch.value[c < channels ? c : 0];
            mean += out.pair.value[side][c] / 3.0;
        }
        out.pair.image[side] = image[side];
        out.pair.xy[side][0] = px;
        out.pair.xy[side][1] = py;
        out.gradient += patch.gradient;
        const lensprof_vignetting centred{};
        const auto &camera = view.image().camera;
        double r = std::sqrt(lensprof_vignetting_r2(&centred, camera.width, camera.height, px, py, nullptr));
        out.radius[side] = std::min(static_cast<int>(r * kRadiusBins), kRadiusBins - 1);
        out.grey[side] = std::min(static_cast<int>(mean * kGreyBins), kGreyBins - 1);
    }
    return true;
}

// Candidates spread evenly over every image (a low-discrepancy sequence), until there are enough or overlaps are used
// up.
std::vector<Candidate> Sampler::candidates(size_t wanted) {
    std::vector<Candidate> found;
    Random random{options_.seed};
    double shift[2] = {random.next(), random.next()};
    size_t sights = 0;  // ways from image to image: a round looks `chunk` times along each
    for (const auto &list : neighbours_) sights += list.size();
    auto chunk = static_cast<uint32_t>(std::clamp<size_t>(4 * wanted / std::max<size_t>(sights, 1), 4, 256));
    const uint32_t most = 102400 / chunk, hopeless = 2560 / chunk;
    for (uint32_t round = 0; round < most && found.size() < wanted && !(round > hopeless && found.empty()); round++)
        for (uint32_t i = 0; i < views_.size(); i++) {
            const auto &camera = views_[i].image().camera;
            for (uint32_t k = round * chunk; k < (round + 1) * chunk; k++) {
                // Roberts' R2 sequence: the plane's generalised golden ratio.
                double a = shift[0] + 0.7548776662466927 * (k + 1.0), b = shift[1] + 0.5698402909980532 * (k + 1.0);
                double x = (a - std::floor(a)) * camera.width - 0.5, y = (b - std::floor(b)) * camera.height - 0.5;
                double direction[2], xy[2];
                if (!views_[i].holds(x, y) || !lensprof_camera_unproject(&camera, x, y, direction)) continue;
                for (uint32_t j : neighbours_[i]) {
                    if (!sees(j, direction, xy)) continue;
                    overlaps_ = true;
                    Candidate candidate;
                    if (measure(i, j, x, y, xy, true, candidate)) found.push_back(candidate);
                }
            }
        }
    return found;
}

// The quietest candidates first, as long as no image pair, radius or grey level has had more than its share; the shares
// grow until enough are found.
std::vector<lensprof_pair> Sampler::balanced(uint32_t wanted) {
    std::vector<Candidate> all = candidates(8 * static_cast<size_t>(wanted));
    std::vector<uint32_t> order(all.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return all[a].gradient != all[b].gradient ? all[a].gradient < all[b].gradient : a < b;
    });
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> per_edge;
    for (const auto &c : all) per_edge[std::minmax(c.pair.image[0], c.pair.image[1])] = 0;
    std::vector<uint32_t> per_radius(kRadiusBins, 0), per_grey(kGreyBins, 0);
    std::vector<bool> taken(all.size(), false);
    std::vector<uint32_t> chosen;
    for (double share : {1.0, 1.5, 2.0, 3.0, 5.0, 1e9}) {
        double edge_limit = share * wanted / std::max<size_t>(per_edge.size(), 1);
        double radius_limit = share * 2.0 * wanted / kRadiusBins, grey_limit = share * 2.0 * wanted / kGreyBins;
        for (uint32_t index : order) {
            if (chosen.size() >= wanted) break;
            const Candidate &c = all[index];
            uint32_t &edge = per_edge[std::minmax(c.pair.image[0], c.pair.image[1])];
            if (taken[index] || edge >= edge_limit || per_radius[c.radius[0]] >= radius_limit
                || per_radius[c.radius[1]] >= radius_limit || per_grey[c.grey[0]] >= grey_limit
                || per_grey[c.grey[1]] >= grey_limit)
                continue;
            taken[index] = true;
            chosen.push_back(index);
            edge++;
            for (int side = 0; side < 2; side++) per_radius[c.radius[side]]++, per_grey[c.grey[side]]++;
        }
    }
    std::sort(chosen.begin(), chosen.end());
    std::vector<lensprof_pair> pairs;
    for (uint32_t index : chosen) pairs.push_back(all[index].pair);
    return pairs;
}

// d'Angelo 5.1: 5n random points, binned by radius; from each of 10 bins the n/10 of lowest gradient.
std::vector<lensprof_pair> Sampler::paper(uint32_t wanted) {
    Random random{options_.seed};
    std::vector<std::vector<Candidate>> bins(kRadiusBins);
    size_t found = 0, trials = 0, most = 200 * static_cast<size_t>(wanted) + 10000;
    while (found < 5 * static_cast<size_t>(wanted) && trials++ < most) {
        auto i = static_cast<uint32_t>(random.next() * static_cast<double>(views_.size()));
        const auto &camera = views_[i].image().camera;
        double x = random.next() * camera.width - 0.5, y = random.next() * camera.height - 0.5, pick = random.next();
        double direction[2], xy[2];
        if (neighbours_[i].empty() || !views_[i].holds(x, y)) continue;
        uint32_t j = neighbours_[i][static_cast<size_t>(pick * static_cast<double>(neighbours_[i].size()))];
        if (!lensprof_camera_unproject(&camera, x, y, direction) || !sees(j, direction, xy)) continue;
        overlaps_ = true;
        Candidate candidate;
        if (!measure(i, j, x, y, xy, false, candidate)) continue;
        bins[static_cast<size_t>(candidate.radius[0])].push_back(candidate);
        found++;
    }
    std::vector<lensprof_pair> pairs;
    for (auto &bin : bins) {
        std::stable_sort(bin.begin(), bin.end(),
                         [](const Candidate &a, const Candidate &b) { return a.gradient < b.gradient; });
        size_t count = std::min<size_t>(bin.size(), std::max(1u, wanted / kRadiusBins));
        for (size_t k = 0; k < count && pairs.size() < wanted; k++) pairs.push_back(bin[k].pair);
    }
    return pairs;
}

lensprof_status check_image(const lensprof_sample_image &image, uint32_t i, lensprof_error *error) {
    lensprof_status status = lensprof_image_validate(&image.view);
    if (status != LENSPROF_OK) return fail(status, error, "image %u: not a valid view of pixels", i);
    status = lensprof_camera_validate(&image.camera);
    if (status != LENSPROF_OK) return fail(status, error, "image %u: not a valid camera", i);
    const auto &view = image.view;
    if (!image.reduction || image.reserved || static_cast<uint64_t>(view.width) * image.reduction > image.camera.width
        || static_cast<uint64_t>(view.height) * image.reduction > image.camera.height)
        return fail(LENSPROF_ERROR_SIZE, error,
                    "image %u: a view of %u x %u reduced %u times does not fit a frame of %u x %u", i, view.width,
                    view.height, image.reduction, image.camera.width, image.camera.height);
    ptrdiff_t width = static_cast<ptrdiff_t>(view.width), row = image.mask_row_bytes;
    if (image.mask && row < width && row > -width)
        return fail(LENSPROF_ERROR_SIZE, error,
                    "image %u: mask rows are %td bytes apart, less than the view's %td pixels", i, row, width);
    if (!(image.black >= 0.0 && image.white <= 1.0 && image.black < image.white))
        return fail(LENSPROF_ERROR_ARGUMENT, error, "image %u: black and white must satisfy 0 <= black < white <= 1",
                    i);
    uint32_t x, y;
    if (View(image).find_not_finite(x, y))
        return fail(LENSPROF_ERROR_NOT_FINITE, error, "image %u: pixel %u, %u is not a finite number", i, x, y);
    return LENSPROF_OK;
}

}  // namespace

extern "C" {

void lensprof_sample_options_init(lensprof_sample_options *options) {
    *options = lensprof_sample_options{};
    options->struct_size = sizeof *options;
    options->seed = 1;
}

lensprof_status lensprof_sample_overlap(const lensprof_sample_options *options, const lensprof_sample_image *images,
                                        uint32_t count, lensprof_pair *pairs, uint32_t capacity, uint32_t *found,
                                        lensprof_error *error) {
    if (error) error->text[0] = 0;
    if (!options || !images || !found || (capacity && !pairs))
        return fail(LENSPROF_ERROR_ARGUMENT, error, "sample: a pointer is NULL");
    if (options->struct_size != sizeof *options)
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "sample options: call lensprof_sample_options_init first");
    if (count < 2) return fail(LENSPROF_ERROR_ARGUMENT, error, "sample: at least two images are needed");
    if (options->sampling > LENSPROF_SAMPLING_PAPER || options->pairs > kLargestCount || count > kLargestCount / 300)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "sample: unknown sampling, or too many images or pairs");
    uint32_t wanted = options->pairs ? options->pairs : std::max(2000u, 300 * count);
    if (capacity == 0) {
        *found = wanted;
        return LENSPROF_OK;
    }
    if (capacity < wanted) return fail(LENSPROF_ERROR_CAPACITY, error, "sample: room for %u pairs is needed", wanted);
    for (uint32_t i = 0; i < count; i++) {
        lensprof_status status = check_image(images[i], i, error);
        if (status != LENSPROF_OK) return status;
    }
    try {
        Sampler sampler(*options, images, count);
        auto result = options->sampling == LENSPROF_SAMPLING_PAPER ? sampler.paper(wanted) : sampler.balanced(wanted);
        if (!sampler.overlaps())
            return fail(LENSPROF_ERROR_NO_OVERLAP, error, "no two images overlap; check the alignment of the project");
        if (result.empty())
            return fail(LENSPROF_ERROR_NO_SAMPLES, error,
                        "the images overlap, but every sample there is masked, black or saturated");
        std::copy(result.begin(), result.end(), pairs);
        *found = static_cast<uint32_t>(result.size());
        return LENSPROF_OK;
    } catch (const std::bad_alloc &) {
        return fail(LENSPROF_ERROR_MEMORY, error, "sample: out of memory");
    } catch (const std::exception &e) {
        return fail(LENSPROF_ERROR_INTERNAL, error, "sample: %s", e.what());
    }
}

}  // extern "C"
