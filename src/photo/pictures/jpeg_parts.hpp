// What a JPEG file holds in addition to its picture: further pictures (CIPA DC-007), among them the gain map of HDR and
// previews, and what phones append, such as the video of a motion photo.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "photo/pictures/mp_index.hpp"

namespace lensprof {

namespace codec {

struct ByteRange {
    uint64_t start = 0, end = 0;
};

struct JpegPart {
    MpPicture picture;  // its entry in the index
    uint64_t start = 0;
};

struct JpegParts {
    uint32_t views = 0;  // pictures of their own that the index lists, such as both of a stereo pair; 0 or at least 2

    uint64_t end = 0;  // of the picture; 0 if it has no end

    // What a corrected JPEG keeps, byte for byte: parts of the file after `end`, the pictures of the index in them (the
    // first entry is the picture itself; empty = no index), and the segment that announces a gain map of ISO 21496-1.
    std::vector<ByteRange> kept;
    std::vector<JpegPart> index;
    std::vector<uint8_t> gain_map_segment;

    std::vector<std::string> kept_names, left_out;  // for messages: "a gain map"
};

// The views alone, from the segments before the pixels.
uint32_t jpeg_views(const std::string &path);

// Empty if the file is not a JPEG or has no end; its reader reports that error.
JpegParts jpeg_parts(const std::string &path);

// Appends what is kept of `source` to the JPEG file `target`, and updates the index.
void append_jpeg_parts(const JpegParts &parts, const std::string &source, const std::string &target);

}  // namespace codec

}  // namespace lensprof
