// Whether a camera has corrected the falloff, according to its maker note.
#pragma once

#include <string>

#include "photo/pictures/maker_note.hpp"

namespace lensprof {

// "Sony: vignetting correction"; empty if nothing states it.
std::string correction_in_notes(const MakerExif &exif);

}  // namespace lensprof
