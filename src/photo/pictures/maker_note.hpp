// Maker notes in another byte order than the EXIF around them.
#pragma once

#include <exiv2/exiv2.hpp>

namespace lensprof {

// EXIF with the fields of maker notes.
struct MakerExif {
    Exiv2::ExifData data;
    Exiv2::ByteOrder order = Exiv2::invalidByteOrder;
};

// Programs that write EXIF in another byte order copy the maker note as it is. Notes without a byte order of their own
// (Canon, Sony, Panasonic) are then read again, in the order in which their directory makes sense. Adapts the byte
// order, too.
void repair_maker_note(MakerExif &exif);

}  // namespace lensprof
