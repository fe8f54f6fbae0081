// A reconstruction given as a file or the folder of a project.
#pragma once

#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/reconstruction/reconstruction.hpp"

namespace lensprof {

// Whether the path is a reconstruction, by content: a file of COLMAP (database), OpenSfM, OpenDroneMap, Bundler,
// AliceVision or OpenMVG, or a folder with a COLMAP model or one of these files under its usual name.
bool is_reconstruction(const std::string &path);

// All files that are, or may be, read.
std::vector<std::string> files_of_reconstruction(const std::string &path);

// For a folder with a COLMAP model: its tracks and poses, with the feature shapes of the database next to it, if they
// belong together. Prints a note on what was read if a folder contains more than one.
Reconstruction read_reconstruction(const std::string &path, Events &events);

}  // namespace lensprof
