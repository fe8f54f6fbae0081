// Detects from metadata whether the camera or a raw converter has already corrected the falloff.
#pragma once

#include <string>

#include <lensprof/profile.h>

#include "photo/pictures/picture_blocks.hpp"
#include "photo/pictures/xmp_packet.hpp"

namespace lensprof {

// Whether a program developed the picture with its own response, regardless of the camera's switches, and only copied
// the camera's notes: raw converters, and this program's simulation. Programs of the makers follow the switches.
bool is_of_converter(const Exif &exif, const Xmp &xmp);

// Who corrected it and the evidence, "in camera (Sony: vignetting correction)"; empty if nothing states it. Maker
// notes, whose statement is `by_camera`, describe only the camera's own JPEG, not other files or JPEGs whose Software
// is a raw converter, which copies the notes from the raw file.
std::string falloff_corrected_by(const PictureBlocks &blocks, const Xmp &xmp, const std::string &by_camera,
                                 const lensprof_profile_key &key);

}  // namespace lensprof
