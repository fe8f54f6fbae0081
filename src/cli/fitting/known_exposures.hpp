// Exposures by EXIF, as soft observations of the images.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/fitting.hpp"

namespace lensprof {

// Each with the standard error that is asked for (--exif-sigma). Without that, what EXIF rounds to thirds of a stop is
// known to 0.1 EV, but pictures at one manual exposure of one camera are alike to 0.03 EV: shutters and apertures
// scatter no more. Of several such groups of pictures the largest has that error: between groups, rounding counts.
void add_known_exposures(const FitOptions &o, const std::vector<std::string> &files,
                         const std::vector<PictureMetadata> &metadata, std::vector<lensprof_fit_image> &images,
                         Streams &streams);

}  // namespace lensprof
