// EXIF exposures as soft observations of the images.
#pragma once

#include <string>
#include <vector>

#include "photo/calibration/fit.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// Exposures according to EXIF, EV. A field that EXIF lacks in all pictures of a camera (ISO), or of one lens on it
// (aperture), cancels: exposures are then relative to each other. Pictures that lack a field which others state have
// unknown exposures, as have those without a time, which cameras vary. Pictures of two lenses without apertures are not
// comparable: of such groups, the largest of a camera is known.
struct ExifExposures {
    std::vector<double> ev;      // per picture; NaN = unknown
    std::vector<bool> is_apart;  // per picture: stated, but not comparable with the known ones
    bool cancels_iso = false, cancels_aperture = false;
};
ExifExposures exif_exposures(const std::vector<PictureMetadata> &metadata, const std::vector<uint32_t> &camera_of);

// The same for the report, with a note if EXIF states exposures only in part.
ExifUse exif_use(const ExifExposures &exposures, const std::vector<PictureMetadata> &metadata,
                 const std::vector<std::string> &names);

// Sets the requested standard error (exif_sigma). Without a request: EXIF rounds to thirds of a stop and is known
// to 0.1 EV, but pictures of one camera at one manual exposure agree to 0.03 EV, the scatter of shutter and aperture.
// Of several such groups only the largest gets this error; between groups the rounding counts. Gives the note.
ExifUse add_known_exposures(const FitOptions &o, const Scene &scene, const std::vector<PictureMetadata> &metadata,
                            std::vector<lensprof_fit_image> &images, Events &events);

// Adds to findings on the known exposure of a picture where it is from: what EXIF states, or the options.
void name_sources(const std::vector<PictureMetadata> &metadata, bool is_from_options, Verdict &verdict);

}  // namespace lensprof
