// Tags that refer to further pictures and videos in a file, which are false in a copy without them.
#pragma once

#include <exiv2/exiv2.hpp>

namespace lensprof {

namespace codec {

// Removes from XMP: lists of parts (Google), gain maps (Adobe, Apple), motion photos.
void remove_part_tags(Exiv2::XmpData &xmp);

// Removes from XMP what describes the extended XMP of a JPEG, which is not copied: depth maps and pictures in it.
void remove_extended_tags(Exiv2::XmpData &xmp);

// Removes Apple's HDRHeadroom and HDRGain, which describe a gain map, from the maker note.
void remove_gain_map_tags(Exiv2::ExifData &exif);

}  // namespace codec

}  // namespace lensprof
