// The pictures of a reconstruction.
#pragma once

#include <string>
#include <vector>

#include "cli/reconstruction/reconstruction.hpp"

namespace lensprof {

// The file of an image in a folder of pictures: its name below it, or where that is none, or the name is absolute, the
// last part of the name.
std::string picture_of_name(const std::string &folder, const std::string &name);

// The file of each image. Names begin in `folder`; where that is empty, in the folder that the reconstruction names, in
// its own, or in `images` in or above that, whichever holds most. Failure (unreadable) for pictures that are missing;
// with `may_lack` the result is empty where none is there.
std::vector<std::string> find_pictures(const Reconstruction &reconstruction, const std::string &folder, bool may_lack);

// Turns the image coordinates into px of the stored pictures, and gives each image a camera of the stored size. Without
// files the sizes are those of the cameras. Failure (unreadable) for a picture of another size than the reconstruction
// says, which was resized or turned since, and for features outside of it.
void settle_coordinates(Reconstruction &reconstruction, const std::vector<std::string> &files);

}  // namespace lensprof
