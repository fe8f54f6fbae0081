// EXIF in the PNG chunk eXIf (PNG 3rd edition, 11.3.4.5). Exiv2 reads it but writes a hexadecimal text chunk instead,
// which is not part of the standard and which ExifTool does not edit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace Exiv2 {
class ExifData;
class Image;
}  // namespace Exiv2

namespace lensprof {

namespace codec {

// Of several values of one key the last is kept: if a text chunk has EXIF too, eXIf wins.
void keep_last(Exiv2::ExifData &exif);

// Removes the image's EXIF and returns it as a TIFF structure; empty if not found. Throws Exiv2's exceptions.
std::vector<uint8_t> take_exif(Exiv2::Image &image);

// Adds EXIF as a chunk after the header of a PNG file; unchanged if `exif` is empty.
std::vector<uint8_t> with_exif(const uint8_t *png, size_t size, const std::vector<uint8_t> &exif);

}  // namespace codec

}  // namespace lensprof
