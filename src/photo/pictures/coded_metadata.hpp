// EXIF and XMP of HEIF, WebP and JPEG XL files for Exiv2, which cannot read all of them: private to metadata.cpp.
#pragma once

#include <memory>
#include <string>

#include <exiv2/exiv2.hpp>

#include "photo/pictures/coded_kind.hpp"

namespace lensprof {

// The metadata of the file, with the size of the picture as read and the matching orientation. Throws Failure and the
// exceptions of Exiv2. The caller ensures that only one thread at a time uses Exiv2.
std::unique_ptr<Exiv2::Image> open_coded_image(const std::string &path, const CodedKind &kind);

// Whether a file is as cameras write it, with unmodified pixels: a JPEG, an HEIC, a JPEG stored in a JPEG XL.
bool is_of_camera(const Exiv2::Image &image);

}  // namespace lensprof
