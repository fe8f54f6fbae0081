// Exposures according to the settings of the camera, and their errors.
#pragma once

#include <vector>

#include <lensprof/exposure_settings.h>

namespace lensprof {

// Per picture.
std::vector<lensprof_known_exposure> known_exposures(const std::vector<lensprof_exposure_settings> &settings);

}  // namespace lensprof
