// The pictures of a reconstruction.
#pragma once

#include <string>
#include <vector>

#include "photo/reconstruction/reconstruction.hpp"

namespace lensprof {

// The file of an image in a folder of pictures: its name relative to the folder or, if that does not exist or the name
// is absolute, the last component of the name.
std::string picture_of_name(const std::string &folder, const std::string &name);

// The file per image. Names are relative to `folder`; if that is empty, to the folder stated by the reconstruction, its
// own folder, or `images` in or above that, whichever contains most. Failure (unreadable) for missing pictures; with
// `allow_missing` the result is empty if none exists.
std::vector<std::string> find_pictures(const Reconstruction &reconstruction, const std::string &folder,
                                       bool allow_missing);

// Converts the image coordinates to px of the stored pictures, and gives each image a camera of the stored size.
// Without files the sizes are those of the cameras. Failure (unreadable) for a picture of another size than the
// reconstruction states (resized or rotated since), and for features outside it.
void convert_coordinates(Reconstruction &reconstruction, const std::vector<std::string> &files);

}  // namespace lensprof
