// Writes measured exposures as EXIF, for programs that read exposures from it.
#pragma once

#include <vector>

#include "photo/correct/correction.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// Sets the EXIF exposure of each job to that of its output: the ExposureTime is chosen so that, with the picture's
// aperture and ISO, exposures differ between pictures by the measured EV. The common offset is the median difference
// between the measured exposures and the pictures' own EXIF; if no picture states its exposure, the mean is 1/60 s at
// f/2.8 and ISO 100. Unknown aperture and ISO are written with these values. `exposures` are those of all pictures of
// the project, so that a part of the pictures gets the same values as the whole.
void seed_exif(std::vector<Correction> &jobs, const Scene &scene, const std::vector<lensprof_exposure> &exposures);

}  // namespace lensprof
