#include "cli/fitting/known_exposures.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "cli/program/message.hpp"

namespace lensprof {
namespace {

constexpr double kRoundedSigma = 0.1, kRepeatedSigma = 0.03;  // EV
constexpr double kMaxAbsEv = 40.0;           // EV relative to 1 s, f/1, ISO 100: no picture has such an exposure
constexpr double kRelativeTolerance = 1e-3;  // relative tolerance of times, apertures and ISO

bool is_possible(const PictureMetadata &m) { return m.exif_ev && std::fabs(*m.exif_ev) < kMaxAbsEv; }

bool is_same(std::optional<double> a, std::optional<double> b) { return std::fabs(*a / *b - 1.0) < kRelativeTolerance; }

// Whether two pictures have the same camera, lens, time, aperture and ISO, set manually.
bool is_one_manual_exposure(const PictureMetadata &a, const PictureMetadata &b) {
    return is_possible(a) && is_possible(b) && a.is_manual && b.is_manual
           && is_same(a.exposure_time_s, b.exposure_time_s) && is_same(a.f_number, b.f_number) && is_same(a.iso, b.iso)
           && !std::strcmp(a.key.camera_model, b.key.camera_model) && !std::strcmp(a.key.lens, b.key.lens)
           && !std::strcmp(a.key.unit, b.key.unit);
}

// The first picture of the largest group (at least two) at one manual exposure; the number of pictures if there is
// none.
size_t largest_group(const std::vector<PictureMetadata> &metadata) {
    size_t first = metadata.size();
    std::ptrdiff_t max_count = 1;
    std::vector<bool> seen(metadata.size());
    for (size_t i = 0; i < metadata.size(); i++) {
        if (seen[i]) continue;
        std::ptrdiff_t count = 0;
        for (size_t k = i; k < metadata.size(); k++) {
            if (!is_one_manual_exposure(metadata[i], metadata[k])) continue;
            seen[k] = true, count++;
        }
        if (count > max_count) max_count = count, first = i;
    }
    return first;
}

}  // namespace

void add_known_exposures(const FitOptions &o, const std::vector<std::string> &files,
                         const std::vector<PictureMetadata> &metadata, std::vector<lensprof_fit_image> &images,
                         Streams &streams) {
    if (o.exif_sigma == 0.0) return;
    const size_t group_image = largest_group(metadata);
    for (size_t i = 0; i < images.size(); i++) {
        if (!metadata[i].exif_ev) continue;
        if (!is_possible(metadata[i])) {
            warn(streams, files[i] + ": time, aperture and ISO in its EXIF are not plausible and not used");
            continue;
        }
        const bool is_repeated =
            group_image < metadata.size() && is_one_manual_exposure(metadata[group_image], metadata[i]);
        images[i].known_ev = *metadata[i].exif_ev;
        images[i].known_ev_sigma = std::max(o.exif_sigma.value_or(is_repeated ? kRepeatedSigma : kRoundedSigma), 1e-3);
    }
}

}  // namespace lensprof
