// Measured exposures as EXIF, for programs that start from it.
#pragma once

#include <vector>

#include "cli/correct/correction.hpp"
#include "cli/fitting/project.hpp"

namespace lensprof {

// Gives each job the EXIF of the exposure that its output has: an ExposureTime that, with the aperture and the ISO of
// its picture, differs from those of the others by the measured EV. On the whole they are as far from the pictures' own
// EXIF as the median of these says; where no picture states its exposure, the mean is 1/60 s at f/2.8 and ISO 100.
// Apertures and ISO that are not known are written as these. `exposures` are those of all pictures of the project, so
// that a part of them gets what it would get with the others.
void seed_exif(std::vector<Correction> &jobs, const Project &project, const std::vector<lensprof_exposure> &exposures);

}  // namespace lensprof
