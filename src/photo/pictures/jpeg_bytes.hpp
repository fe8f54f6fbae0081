// A JPEG in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "photo/pictures/picture.hpp"

namespace lensprof {

// Baseline JPEG of an 8 bit grey or RGB picture, without metadata. quality: 1..100.
std::vector<uint8_t> jpeg_bytes(const Picture &picture, int quality);

}  // namespace lensprof
