// The file of measured exposures, exposures.json: EV and white balance with standard errors per image, the response per
// camera, the falloff per lens setting. See lensprof/exposures.h.
#pragma once

#include <string>

#include "photo/calibration/scene_fit.hpp"

namespace lensprof {

// The text of the file, to be written to `path`: file names are relative to its folder.
std::string exposures_text(const SceneFit &state, const Scene &scene, const std::vector<PictureMetadata> &metadata,
                           const std::string &path);

}  // namespace lensprof
