// Hugin projects, as which a scene is read and written.
#pragma once

#include <string>

#include "photo/scene/scene.hpp"

namespace lensprof {

// The reference is the first image whose Eev is not free, else image 0.
Scene read_hugin_project(const std::string &path);

// The scene as a project to be written to `path`, whose names are relative to the folder of that file. It keeps
// everything that the project of the scene states.
Pto hugin_project(const Scene &scene, const std::string &path);

void write_hugin_project(const Scene &scene, const std::string &path);

}  // namespace lensprof
