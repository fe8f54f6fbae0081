// Small copies of pictures, turned as EXIF's orientation states.
#pragma once

#include <cstdint>
#include <vector>

#include "cli/pictures/picture.hpp"

namespace lensprof {

// Turns 8 bit RGB pixels without gaps as EXIF's orientation states.
void turn_upright(uint16_t orientation, uint32_t &width, uint32_t &height, std::vector<uint8_t> &rgb);

// 8 bit RGB, upright, the longer side at most `side` pixels: means over boxes of the stored 8 bit picture.
Picture upright_copy(const Picture &stored, uint16_t orientation, uint32_t side);

}  // namespace lensprof
