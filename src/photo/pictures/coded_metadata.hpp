// EXIF, XMP and colour profile of HEIF, WebP and JPEG XL files.
#pragma once

#include <string>

#include "photo/pictures/coded_kind.hpp"
#include "photo/pictures/picture_blocks.hpp"

namespace lensprof {

// The metadata of the file, with the size of the picture as read and the matching orientation. Throws Failure.
PictureBlocks read_coded_blocks(const std::string &path, const CodedKind &kind);

}  // namespace lensprof
