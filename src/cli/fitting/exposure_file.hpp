// The file of measured exposures, exposures.json: of every image EV and white balance with their standard errors, of
// every camera the response, of every lens setting the falloff. docs/reconstructions.md describes it.
#pragma once

#include <string>

#include "cli/fitting/project_fit.hpp"

namespace lensprof {

// The text of the file, to be written to `path`: names of files are relative to its folder.
std::string exposures_text(const ProjectFit &done, const Project &project, const std::vector<PictureMetadata> &metadata,
                           const std::string &path);

// Whether a file is one of exposures, by its first lines.
bool is_exposure_file(const std::string &path);

// The file as a project of which each image has a model. Pictures are those it names, or where `images` is not empty
// the images' names in that folder. Failure (unreadable) for a file that is damaged or something else.
Project read_exposures(const std::string &path, const std::string &images);

}  // namespace lensprof
