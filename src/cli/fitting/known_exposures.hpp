// EXIF exposures as soft observations of the images.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/fitting.hpp"

namespace lensprof {

// Sets the requested standard error (--exif-sigma). Without a request: EXIF rounds to thirds of a stop and is known to
// 0.1 EV, but pictures of one camera at one manual exposure agree to 0.03 EV, the scatter of shutter and aperture. Of
// several such groups only the largest gets this error; between groups the rounding counts.
void add_known_exposures(const FitOptions &o, const std::vector<std::string> &files,
                         const std::vector<PictureMetadata> &metadata, std::vector<lensprof_fit_image> &images,
                         Streams &streams);

}  // namespace lensprof
