#include "photo/calibration/known_exposures.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <tuple>

#include "photo/base/format.hpp"

namespace lensprof {
namespace {

// "1/320 s, f/8, ISO 100", as far as EXIF states it.
std::string exposure_text(const PictureMetadata &stated) {
    const double time_s = *stated.exposure_time_s;
    std::string text = time_s > 0.0 && time_s < 0.4 ? format("1/%.0f s", 1.0 / time_s) : format("%.3g s", time_s);
    if (stated.f_number) text += format(", f/%.3g", *stated.f_number);
    if (stated.iso) text += format(", ISO %.0f", *stated.iso);
    return text;
}

constexpr double kRoundedSigma = 0.1, kRepeatedSigma = 0.03;  // EV
constexpr double kMaxAbsEv = 40.0;           // EV relative to 1 s, f/1, ISO 100: no picture has such an exposure
constexpr double kRelativeTolerance = 1e-3;  // relative tolerance of times, apertures and ISO

bool is_possible(double ev) { return std::fabs(ev) < kMaxAbsEv; }

bool is_same(std::optional<double> a, std::optional<double> b) { return std::fabs(*a / *b - 1.0) < kRelativeTolerance; }

// Whether two pictures have the same camera, lens, time, aperture and ISO, set manually.
bool is_one_manual_exposure(const PictureMetadata &a, const PictureMetadata &b) {
    return a.exif_ev && b.exif_ev && is_possible(*a.exif_ev) && a.is_manual && b.is_manual
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

// A lens of a camera. Without a name, lenses are distinguished by their focal length.
using Lens = std::tuple<uint32_t, std::string, double>;

Lens lens_of(const lensprof_profile_key &key, uint32_t camera) {
    return {camera, key.lens, *key.lens ? 0.0 : key.focal_mm};
}

// Pictures with comparable exposures: of one camera and, if the aperture cancels, of one lens.
using Comparable = std::tuple<uint32_t, bool, Lens>;

std::map<Comparable, std::vector<size_t>> comparable_pictures(const std::vector<PictureMetadata> &metadata,
                                                              const std::vector<uint32_t> &camera_of,
                                                              ExifExposures &exposures) {
    std::set<uint32_t> states_iso;
    std::set<Lens> states_aperture;
    for (size_t i = 0; i < metadata.size(); i++) {
        if (metadata[i].iso) states_iso.insert(camera_of[i]);
        if (metadata[i].f_number) states_aperture.insert(lens_of(metadata[i].key, camera_of[i]));
    }
    std::map<Comparable, std::vector<size_t>> groups;
    for (size_t i = 0; i < metadata.size(); i++) {
        const PictureMetadata &m = metadata[i];
        const Lens lens = lens_of(m.key, camera_of[i]);
        const bool cancels_aperture = !states_aperture.count(lens);
        if (!m.exposure_time_s || (!m.iso && states_iso.count(camera_of[i])) || (!m.f_number && !cancels_aperture))
            continue;
        exposures.ev[i] = exposure_ev(*m.exposure_time_s, m.iso.value_or(100.0), m.f_number.value_or(1.0));
        groups[{camera_of[i], cancels_aperture, cancels_aperture ? lens : Lens{}}].push_back(i);
    }
    return groups;
}

}  // namespace

ExifExposures exif_exposures(const std::vector<PictureMetadata> &metadata, const std::vector<uint32_t> &camera_of) {
    ExifExposures exposures;
    exposures.ev.assign(metadata.size(), NAN);
    exposures.is_apart.assign(metadata.size(), false);
    const auto groups = comparable_pictures(metadata, camera_of, exposures);
    std::map<uint32_t, const std::vector<size_t> *> largest;  // per camera
    for (const auto &[key, pictures] : groups) {
        const std::vector<size_t> *&best = largest[std::get<0>(key)];
        if (!best || pictures.size() > best->size()) best = &pictures;
    }
    for (const auto &[key, pictures] : groups) {
        const bool is_used = largest[std::get<0>(key)] == &pictures;
        for (const size_t i : pictures) {
            if (!is_used) exposures.ev[i] = NAN, exposures.is_apart[i] = true;
            exposures.cancels_iso |= is_used && !metadata[i].iso;
            exposures.cancels_aperture |= is_used && !metadata[i].f_number;
        }
    }
    return exposures;
}

// Whether EXIF states anything about exposures; the aperture alone describes the lens.
static bool states_exposures(const std::vector<PictureMetadata> &metadata) {
    return std::any_of(metadata.begin(), metadata.end(),
                       [](const PictureMetadata &m) { return m.exposure_time_s || m.iso; });
}

// The field without which EXIF does not give the exposure of a picture.
static const char *missing_field(const PictureMetadata &m, bool cancels_iso) {
    return !m.exposure_time_s ? "exposure time" : !m.iso && !cancels_iso ? "ISO" : "aperture";
}

ExifUse exif_use(const ExifExposures &exposures, const std::vector<PictureMetadata> &metadata,
                 const std::vector<std::string> &names) {
    ExifUse use;
    std::map<std::string, std::vector<uint32_t>> missing;  // by field
    std::vector<uint32_t> apart;
    use.images = names.size();
    for (uint32_t i = 0; i < names.size(); i++) {
        if (!std::isnan(exposures.ev[i])) continue;
        use.images--;
        (exposures.is_apart[i] ? apart : missing[missing_field(metadata[i], exposures.cancels_iso)]).push_back(i);
    }
    use.cancels_iso = exposures.cancels_iso, use.cancels_aperture = exposures.cancels_aperture;
    if (!states_exposures(metadata) || !(use.images < names.size() || use.cancels_iso || use.cancels_aperture))
        return use;
    use.note = "EXIF gives the exposures of " + std::to_string(use.images) + " of " + counted(names.size(), "picture");
    if (use.cancels_iso && use.cancels_aperture)
        use.note += ", by the time alone: it states neither ISO nor aperture";
    else if (use.cancels_iso || use.cancels_aperture)
        use.note +=
            use.cancels_iso ? ", by time and aperture: it states no ISO" : ", by time and ISO: it states no aperture";
    if (!apart.empty())
        use.note += "; not comparable with these, because a lens states no aperture: " + listed(apart, names);
    for (const auto &[field, images] : missing) use.note += "; without " + field + ": " + listed(images, names);
    return use;
}

ExifUse add_known_exposures(const FitOptions &o, const Scene &scene, const std::vector<PictureMetadata> &metadata,
                            std::vector<lensprof_fit_image> &images, Events &events) {
    if (o.exif_sigma == 0.0) return {};
    std::vector<uint32_t> camera_of;
    for (const lensprof_fit_image &image : images) camera_of.push_back(image.camera);
    ExifExposures exposures = exif_exposures(metadata, camera_of);
    const size_t group_image = largest_group(metadata);
    for (size_t i = 0; i < images.size(); i++) {
        if (std::isnan(exposures.ev[i])) continue;
        if (!is_possible(exposures.ev[i])) {
            exposures.ev[i] = NAN;
            events.warn(scene.files[i], "time, aperture and ISO in its EXIF are not plausible and not used");
            continue;
        }
        const bool is_repeated =
            group_image < metadata.size() && is_one_manual_exposure(metadata[group_image], metadata[i]);
        images[i].known_ev = exposures.ev[i];
        images[i].known_ev_sigma = std::max(o.exif_sigma.value_or(is_repeated ? kRepeatedSigma : kRoundedSigma), 1e-3);
    }
    const ExifUse use = exif_use(exposures, metadata, scene.names);
    if (!use.note.empty()) events.note(scene.path, use.note + advice("exif_used"));
    return use;
}

void name_sources(const std::vector<PictureMetadata> &metadata, bool is_from_options, Verdict &verdict) {
    for (Finding &finding : verdict.findings) {
        const bool is_known = finding.code == LENSPROF_REASON_KNOWN_WRONG || finding.code == LENSPROF_REASON_KNOWN_STEP;
        if (!is_known || finding.item.index >= metadata.size()) continue;
        const PictureMetadata &stated = metadata[finding.item.index];
        if (is_from_options)
            finding.text += advice("exposure_of_options");
        else if (stated.exposure_time_s)
            finding.text += "; EXIF states " + exposure_text(stated);
    }
}

}  // namespace lensprof
