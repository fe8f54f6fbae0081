// EXIF in a PNG's own chunk for it, eXIf (PNG 3rd edition, 11.3.4.5). Exiv2 reads it, but writes a text chunk in
// hexadecimal instead, which is not part of the standard and which ExifTool does not edit.
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

// Of several values of one key the last remains: where EXIF stands in a text chunk as well, that of eXIf.
void keep_last(Exiv2::ExifData &exif);

// The image's EXIF as a TIFF structure, which it then is without; empty where it has none. Throws Exiv2's exceptions.
std::vector<uint8_t> take_exif(Exiv2::Image &image);

// A PNG file with EXIF in a chunk after its header; as it is where `exif` is empty.
std::vector<uint8_t> with_exif(const uint8_t *png, size_t size, const std::vector<uint8_t> &exif);

}  // namespace codec

}  // namespace lensprof
