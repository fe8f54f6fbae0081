// The strips and tiles of a camera raw file with the structure of a TIFF, before LibRaw decodes them: where one is not
// what the directory declares, LibRaw stops without an error and leaves the rest of the pixels as they are.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace lensprof {

namespace codec {

// Bytes of the lossless JPEGs of the raw image, by their offset in the file.
using RawBlocks = std::map<uint64_t, uint64_t>;

// Failure (unreadable) where a strip or tile of a raw image ends after the end of the file, or a lossless JPEG of the
// one of `width` x `height` does not begin as such or is smaller than its strip or tile. Files of another structure
// have no blocks.
RawBlocks check_raw_blocks(const std::string &path, uint32_t width, uint32_t height);

}  // namespace codec

}  // namespace lensprof
