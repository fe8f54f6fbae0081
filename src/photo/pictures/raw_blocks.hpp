// Checks the strips and tiles of a TIFF-based camera raw file before LibRaw decodes them: if one is not what the
// directory declares, LibRaw stops without an error and leaves the remaining pixels unset.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace lensprof {

namespace codec {

// Bytes of the lossless JPEGs of the raw image, by file offset.
using RawBlocks = std::map<uint64_t, uint64_t>;

// Failure (unreadable) if a strip or tile of a raw image ends beyond the end of the file, or if a lossless JPEG of the
// raw image of `width` x `height` has no valid header or is smaller than its strip or tile. Files of another structure
// have no blocks.
RawBlocks check_raw_blocks(const std::string &path, uint32_t width, uint32_t height);

}  // namespace codec

}  // namespace lensprof
