// Hugin point files: pairs of a scene in pixels of its pictures.
#pragma once

#include <string>
#include <vector>

#include "photo/scene/scene.hpp"

namespace lensprof {

// The pairs of a point file, which holds pixels of the pictures; they must refer to images of the project.
std::vector<lensprof_pair> read_points(const std::string &path, const Scene &scene);
std::string points_text(std::vector<lensprof_pair> pairs, const Scene &scene);

}  // namespace lensprof
