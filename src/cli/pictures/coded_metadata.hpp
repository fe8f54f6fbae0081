// EXIF and XMP of HEIF, WebP and JPEG XL files for Exiv2, which reads not all of them: private to metadata.cpp.
#pragma once

#include <memory>
#include <string>

#include <exiv2/exiv2.hpp>

#include "cli/pictures/coded_kind.hpp"

namespace lensprof {

// The metadata as the file has them, with the size of the picture as it is read and the orientation that belongs to it.
// Throws Failure, and what Exiv2 throws. The caller lets one thread at a time use Exiv2.
std::unique_ptr<Exiv2::Image> open_coded_image(const std::string &path, const CodedKind &kind);

// A file as cameras write them, whose pixels nothing has changed since: a JPEG, an HEIC, a JPEG kept in a JPEG XL.
bool is_of_camera(const Exiv2::Image &image);

}  // namespace lensprof
