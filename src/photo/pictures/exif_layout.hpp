// Writes EXIF as a TIFF structure.
#pragma once

#include <cstdint>
#include <vector>

#include "photo/pictures/exif_fields.hpp"

namespace lensprof {

// Header, directories and values. A maker note stays at its offset, from which the offsets in it may count, if that is
// near the start; else moved_note() adjusts it. Empty if there are no fields.
std::vector<uint8_t> exif_block(const Exif &exif);

// Directories and values to append to a TIFF of `start` bytes (even), whose fields with a place stay there. `next`: of
// the main directory, which comes first.
std::vector<uint8_t> appended_exif(const Exif &exif, uint64_t start, uint32_t next);

}  // namespace lensprof
