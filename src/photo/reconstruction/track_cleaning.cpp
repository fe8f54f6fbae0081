#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <unordered_set>

#include "photo/base/failure.hpp"
#include "photo/base/paths.hpp"
#include "photo/reconstruction/reconstruction.hpp"

namespace lensprof {

namespace {

// Requires valid, unique file names and numeric positions.
void check(const Reconstruction &r) {
    const auto fail = [&](const std::string &message) {
        throw Failure(LENSPROF_ERROR_READ, r.path + ": " + message + "; give an intact file");
    };
    if (r.images.size() > max_images) fail("has " + std::to_string(r.images.size()) + " images, more than supported");
    std::unordered_set<std::string> names;
    for (const ReconstructionImage &image : r.images) {
        if (image.name.empty() || image.name.find('\0') != std::string::npos) fail("has an image without a name");
        if (!names.insert(image.name).second) fail("has the image " + short_name(image.name) + " twice");
    }
    for (const TrackObservation &observation : r.observations)
        if (!std::isfinite(observation.xy[0]) || !std::isfinite(observation.xy[1]))
            fail("has a feature in " + short_name(r.images[observation.image].name)
                 + " whose position is not a number");
}

}  // namespace

void clean_tracks(Reconstruction &reconstruction) {
    check(reconstruction);
    auto &all = reconstruction.observations;
    std::stable_sort(all.begin(), all.end(), [](const TrackObservation &a, const TrackObservation &b) {
        return std::tuple(a.point, a.image) < std::tuple(b.point, b.image);
    });
    std::vector<std::array<double, 3>> positions;
    size_t kept = 0;
    uint32_t points = 0;
    for (size_t first = 0, last = 0; first < all.size(); first = last) {
        bool is_twice = false;
        for (last = first; last < all.size() && all[last].point == all[first].point; last++)
            is_twice = is_twice || (last > first && all[last].image == all[last - 1].image);
        if (is_twice || last - first < 2) continue;
        const uint32_t point = all[first].point;
        if (!reconstruction.points.empty()) positions.push_back(reconstruction.points[point]);
        for (size_t n = first; n < last; n++) {
            all[kept] = all[n];
            all[kept++].point = points;
        }
        points++;
    }
    all.resize(kept);
    reconstruction.points = std::move(positions);
    if (all.empty())
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      reconstruction.path + ": no point is visible in two of its images; match the pictures first",
                      LENSPROF_REASON_FEW_PAIRS);
}

void sort_images(Reconstruction &reconstruction) {
    auto &images = reconstruction.images;
    std::vector<uint32_t> order(images.size()), number(images.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return images[a].name < images[b].name; });
    std::vector<ReconstructionImage> sorted;
    for (uint32_t n = 0; n < order.size(); n++) {
        number[order[n]] = n;
        sorted.push_back(images[order[n]]);
    }
    images = std::move(sorted);
    for (TrackObservation &observation : reconstruction.observations) observation.image = number[observation.image];
    std::sort(reconstruction.observations.begin(), reconstruction.observations.end(),
              [](const TrackObservation &a, const TrackObservation &b) {
                  return std::tuple(a.point, a.image) < std::tuple(b.point, b.image);
              });
}

void keep_images(const std::vector<uint32_t> &kept, Reconstruction &reconstruction) {
    std::vector<uint32_t> number(reconstruction.images.size(), UINT32_MAX);
    std::vector<ReconstructionImage> images;
    for (const uint32_t image : kept) {
        number[image] = static_cast<uint32_t>(images.size());
        images.push_back(reconstruction.images[image]);
    }
    auto &all = reconstruction.observations;
    for (TrackObservation &observation : all) observation.image = number[observation.image];
    all.erase(
        std::remove_if(all.begin(), all.end(), [](const auto &observation) { return observation.image == UINT32_MAX; }),
        all.end());
    reconstruction.images = std::move(images);
    clean_tracks(reconstruction);
}

bool is_finite(const std::array<double, 3> &vector) {
    return std::all_of(vector.begin(), vector.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace lensprof
