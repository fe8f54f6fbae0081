// The boxes of a file (ISO/IEC 14496-12, 4.2), which HEIF and JPEG XL consist of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>

namespace lensprof {

namespace codec {

// A number of at most 8 bytes.
uint64_t big_endian(const uint8_t *bytes, size_t count);

// Calls `visit` with type, start and size of the content of each box, until it returns false or the file is damaged.
void each_box(std::FILE *file,
              const std::function<bool(const std::string &type, uint64_t start, uint64_t size)> &visit);

}  // namespace codec

}  // namespace lensprof
