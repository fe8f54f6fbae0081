// Properties of XMP that refer to further pictures and videos in a file, which are false in a copy without them.
#pragma once

#include "photo/pictures/xmp_packet.hpp"

namespace lensprof {

namespace codec {

// Removes lists of parts (Google), gain maps (Adobe, Apple), motion photos.
void remove_part_tags(Xmp &xmp);

// Removes what describes the extended XMP of a JPEG, which is not copied: depth maps and pictures in it.
void remove_extended_tags(Xmp &xmp);

}  // namespace codec

}  // namespace lensprof
