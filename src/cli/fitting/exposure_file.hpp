// The file of measured exposures, exposures.json: EV and white balance with standard errors per image, the response per
// camera, the falloff per lens setting. See docs/reconstructions.md.
#pragma once

#include <string>

#include "cli/fitting/project_fit.hpp"

namespace lensprof {

// The text of the file, to be written to `path`: file names are relative to its folder.
std::string exposures_text(const ProjectFit &state, const Project &project,
                           const std::vector<PictureMetadata> &metadata, const std::string &path);

// Whether a file is a file of exposures, judged by its first lines.
bool is_exposure_file(const std::string &path);

// Reads the file as a project in which each image has a model. Pictures are the files it names, or, if `images` is not
// empty, the image names in that folder. Failure (unreadable) for a damaged or foreign file.
Project read_exposures(const std::string &path, const std::string &images);

}  // namespace lensprof
