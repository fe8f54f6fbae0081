// A reconstruction by the name that a user gives: a file, or the folder of a project.
#pragma once

#include <string>
#include <vector>

#include "cli/program/run.hpp"
#include "cli/reconstruction/reconstruction.hpp"

namespace lensprof {

// Whether there is one, by content: a file of COLMAP (database), OpenSfM, OpenDroneMap, Bundler, AliceVision or
// OpenMVG, or a folder that holds a COLMAP model or one of these under its usual name.
bool is_reconstruction(const std::string &path);

// Every file that is, or may be, read of it.
std::vector<std::string> files_of_reconstruction(const std::string &path);

// Of a folder with a COLMAP model, its tracks and poses, with the shapes of the features from the database beside it,
// where that belongs to it. States what was read of a folder that holds more than one.
Reconstruction read_reconstruction(const std::string &path, Streams &streams);

}  // namespace lensprof
