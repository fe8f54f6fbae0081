// EXIF exposures as soft observations of the images.
#pragma once

#include <string>
#include <vector>

#include <lensprof/exposure_settings.h>

#include "photo/calibration/fit.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// Exposures according to EXIF. `camera_of`: per picture. Pictures of one body, unit and lens are of one lens; without a
// name, lenses are distinguished by their focal length.
std::vector<lensprof_known_exposure> exif_exposures(const std::vector<PictureMetadata> &metadata,
                                                    const std::vector<uint32_t> &camera_of);

// The same for the report, with a note if EXIF states exposures only in part.
ExifUse exif_use(const std::vector<lensprof_known_exposure> &exposures, const std::vector<PictureMetadata> &metadata,
                 const std::vector<std::string> &names);

// Makes them the known exposures of the images, with the requested standard error (exif_sigma) or their own. Gives the
// note.
ExifUse add_known_exposures(const FitOptions &o, const Scene &scene, const std::vector<PictureMetadata> &metadata,
                            std::vector<lensprof_fit_image> &images, Events &events);

// Adds to findings on the known exposure of a picture where it is from: what EXIF states, or the options.
void name_sources(const std::vector<PictureMetadata> &metadata, bool is_from_options, Verdict &verdict);

}  // namespace lensprof
