#include "photo/correct/seeded_exif.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fit/base/quantile.hpp"
#include "photo/correct/scene_model.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/scene/exposures.hpp"

namespace lensprof {
namespace {

constexpr double usual_time_s = 1.0 / 60.0, usual_aperture = 2.8, usual_iso = 100.0,
                 max_iso = 65535.0;  // of the EXIF tag

double exif_ev_of(double time_s, double aperture, double iso) {
    return std::log2(time_s * iso / 100.0 / (aperture * aperture));
}

// Empty if a picture cannot be read; it may belong to another part of the work.
std::optional<double> stated_ev(const std::string &file) {
    try {
        return read_metadata(file).exif_ev;
    } catch (const Failure &) {
        return {};
    }
}

}  // namespace

void seed_exif(std::vector<Correction> &jobs, const Scene &scene, const std::vector<lensprof_exposure> &exposures) {
    std::vector<double> offsets;  // from measured to stated EV
    for (size_t i = 0; i < exposures.size(); i++) {
        if (scene.images[i].left_out) continue;
        if (const auto stated = stated_ev(scene.files[i])) offsets.push_back(*stated - exposures[i].ev);
    }
    const double usual = exif_ev_of(usual_time_s, usual_aperture, usual_iso);
    const double offset = offsets.empty() ? usual - mean_exposure(joined_exposures(scene, exposures)).ev
                                          : upper_median(std::move(offsets));
    for (Correction &job : jobs) {
        const PictureMetadata metadata = read_metadata(job.source);
        auto seeded = std::make_shared<PictureMetadata>(unknown_metadata());
        const double aperture = metadata.f_number.value_or(usual_aperture),
                     iso = std::min(metadata.iso.value_or(usual_iso), max_iso);
        seeded->key.aperture = aperture, seeded->iso = iso;
        seeded->exposure_time_s = std::exp2(job.target_exposure.ev + offset) * 100.0 / iso * aperture * aperture;
        job.exif = std::move(seeded);
    }
}

}  // namespace lensprof
