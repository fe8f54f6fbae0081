// Maker notes in another byte order than the EXIF around them.
#pragma once

#include <exiv2/exiv2.hpp>

namespace lensprof {

// Programs that write EXIF in another byte order copy the maker note as it is. Notes without a byte order of their own
// (Canon, Sony, Panasonic) are then read again, in the order in which their directory makes sense. Adapts the byte
// order of the image, too. For reading only: the image must not be written afterwards.
void repair_maker_note(Exiv2::Image &image);

}  // namespace lensprof
