#include "cli/correct/seeded_exif.hpp"

#include <algorithm>
#include <cmath>

#include "cli/pictures/metadata.hpp"

namespace lensprof {
namespace {

constexpr double usual_time_s = 1.0 / 60.0, usual_aperture = 2.8, usual_iso = 100.0;

double exif_ev_of(double time_s, double aperture, double iso) {
    return std::log2(time_s * iso / 100.0 / (aperture * aperture));
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

void seed_exif(std::vector<Correction> &jobs, const lensprof_exposure &mean) {
    std::vector<PictureMetadata> own;
    std::vector<double> offsets;  // from measured to stated EV
    for (const Correction &job : jobs) {
        own.push_back(read_metadata(job.source));
        if (own.back().exif_ev) offsets.push_back(*own.back().exif_ev - job.own.ev);
    }
    const double offset =
        offsets.empty() ? exif_ev_of(usual_time_s, usual_aperture, usual_iso) - mean.ev : median(std::move(offsets));
    for (size_t i = 0; i < jobs.size(); i++) {
        auto seeded = std::make_shared<PictureMetadata>(unknown_metadata());
        const double aperture = own[i].f_number.value_or(usual_aperture), iso = own[i].iso.value_or(usual_iso);
        seeded->key.aperture = aperture, seeded->iso = iso;
        seeded->exposure_time_s = std::exp2(jobs[i].wanted.ev + offset) * 100.0 / iso * aperture * aperture;
        jobs[i].exif = std::move(seeded);
    }
}

}  // namespace lensprof
