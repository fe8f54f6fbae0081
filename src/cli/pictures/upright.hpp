// Small copies of pictures, turned as EXIF's orientation states.
#pragma once

#include <cstdint>
#include <utility>

#include "cli/pictures/picture.hpp"

namespace lensprof {

// EXIF's orientation: where the pixel (x, y) of the upright picture is in the stored one of w x h.
std::pair<uint32_t, uint32_t> stored_place(uint16_t orientation, uint32_t w, uint32_t h, uint32_t x, uint32_t y);

// 8 bit RGB, upright, the longer side at most `side` pixels: means over boxes of the stored 8 bit picture.
Picture upright_copy(const Picture &stored, uint16_t orientation, uint32_t side);

}  // namespace lensprof
