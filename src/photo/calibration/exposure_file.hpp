// The file of measured exposures, exposures.json: EV and white balance with standard errors per image, the response per
// camera, the falloff per lens setting. See docs/reconstructions.md.
#pragma once

#include <string>

#include "photo/calibration/scene_fit.hpp"
#include "photo/scene/exposure_reader.hpp"

namespace lensprof {

// The file as JSON; file names are relative to the folder of `path`.
Json exposures_json(const SceneFit &state, const Scene &scene, const std::vector<PictureMetadata> &metadata,
                    const std::string &path);

// The text of the file, to be written to `path`: file names are relative to its folder.
std::string exposures_text(const SceneFit &state, const Scene &scene, const std::vector<PictureMetadata> &metadata,
                           const std::string &path);

}  // namespace lensprof
