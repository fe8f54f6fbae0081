#include "photo/calibration/known_exposures.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "photo/base/format.hpp"
#include "photo/base/library.hpp"

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

// Whether EXIF states anything about exposures; the aperture alone describes the lens.
bool states_exposures(const std::vector<PictureMetadata> &metadata) {
    return std::any_of(metadata.begin(), metadata.end(),
                       [](const PictureMetadata &m) { return m.exposure_time_s || m.iso; });
}

// The field without which EXIF does not give the exposure of a picture; NULL for another state.
const char *missing_field(uint32_t state) {
    switch (state) {
    case LENSPROF_EXPOSURE_NO_TIME: return "exposure time";
    case LENSPROF_EXPOSURE_NO_ISO: return "ISO";
    case LENSPROF_EXPOSURE_NO_APERTURE: return "aperture";
    default: return nullptr;
    }
}

}  // namespace

std::vector<lensprof_known_exposure> exif_exposures(const std::vector<PictureMetadata> &metadata,
                                                    const std::vector<uint32_t> &camera_of) {
    using Lens = std::tuple<std::string, std::string, std::string, double>;
    std::map<Lens, uint32_t> lenses;
    std::vector<lensprof_exposure_settings> settings;
    for (size_t i = 0; i < metadata.size(); i++) {
        const PictureMetadata &m = metadata[i];
        const Lens lens = {m.key.camera_model, m.key.unit, m.key.lens, *m.key.lens ? 0.0 : m.key.focal_mm};
        const uint32_t number = lenses.try_emplace(lens, static_cast<uint32_t>(lenses.size())).first->second;
        settings.push_back({m.exposure_time_s.value_or(LENSPROF_UNKNOWN), m.f_number.value_or(LENSPROF_UNKNOWN),
                            m.iso.value_or(LENSPROF_UNKNOWN), camera_of[i], number, m.is_manual, 0});
    }
    std::vector<lensprof_known_exposure> known(settings.size());
    lensprof_error error{};
    check(lensprof_known_exposures(settings.data(), static_cast<uint32_t>(settings.size()), known.data(), &error),
          "EXIF", &error);
    return known;
}

ExifUse exif_use(const std::vector<lensprof_known_exposure> &exposures, const std::vector<PictureMetadata> &metadata,
                 const std::vector<std::string> &names) {
    ExifUse use;
    std::map<std::string, std::vector<uint32_t>> missing;  // by field
    std::vector<uint32_t> apart;
    for (uint32_t i = 0; i < names.size(); i++) {
        const uint32_t state = exposures[i].state;
        if (const char *field = missing_field(state)) missing[field].push_back(i);
        if (state == LENSPROF_EXPOSURE_APART) apart.push_back(i);
        if (state != LENSPROF_EXPOSURE_KNOWN) continue;
        use.images++;
        use.cancels_iso |= !metadata[i].iso, use.cancels_aperture |= !metadata[i].f_number;
    }
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
    const std::vector<lensprof_known_exposure> exposures = exif_exposures(metadata, camera_of);
    for (size_t i = 0; i < images.size(); i++) {
        const lensprof_known_exposure &known = exposures[i];
        if (known.state == LENSPROF_EXPOSURE_IMPLAUSIBLE)
            events.warn(scene.files[i], "time, aperture and ISO in its EXIF are not plausible and not used");
        if (known.state != LENSPROF_EXPOSURE_KNOWN) continue;
        images[i].known_ev = known.ev;
        images[i].known_ev_sigma = std::max(o.exif_sigma.value_or(known.sigma), 1e-3);
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
