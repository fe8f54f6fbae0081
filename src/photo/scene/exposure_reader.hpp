// Reads the file of measured exposures, exposures.json (lensprof/exposures.h), as a scene.
#pragma once

#include <string>

#include "photo/scene/scene.hpp"

namespace lensprof {

// Whether a file is a file of exposures, judged by its first lines.
bool is_exposure_file(const std::string &path);

// Reads the file as a scene in which each image has a model. Pictures are the files it names, or, if `images` is not
// empty, the image names in that folder. Failure (unreadable) for a damaged or foreign file.
Scene read_exposures(const std::string &path, const std::string &images);
Scene exposures_of(const std::string &text, const std::string &path, const std::string &images);

}  // namespace lensprof
