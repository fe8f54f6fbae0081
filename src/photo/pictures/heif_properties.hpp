// Properties of a HEIF file's primary picture that libheif before 1.16 does not report: private to picture_heif.cpp.
#pragma once

#include <cstdint>
#include <string>

namespace lensprof {

namespace codec {

struct HeifProperties {
    uint16_t orientation = 1;  // orientation that libheif applies while decoding, in EXIF's numbering
    bool is_grey = false;
};

// Defaults if the boxes cannot be read; libheif reports that error.
HeifProperties heif_properties(const std::string &path);

// Boxes and items that libheif skips.
struct HeifContents {
    bool has_tone_map = false;  // an item that combines the primary picture with a gain map (ISO 21496-1)
    bool has_frames = false;    // a sequence of frames
    bool has_video = false;     // the video of a motion photo
};

HeifContents heif_contents(const std::string &path);

// EXIF orientation after rotating by `quarters` quarter turns anticlockwise, or mirroring left and right, a picture
// that already has `orientation`.
uint16_t rotated_anticlockwise(uint16_t orientation, unsigned quarters);
uint16_t mirrored(uint16_t orientation);

}  // namespace codec

}  // namespace lensprof
