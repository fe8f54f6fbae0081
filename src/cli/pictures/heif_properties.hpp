// What a HEIF file states of its primary picture and libheif does not report, in versions before 1.16: private to
// picture_heif.cpp.
#pragma once

#include <cstdint>
#include <string>

namespace lensprof {

namespace codec {

struct HeifProperties {
    uint16_t orientation = 1;  // that libheif gives the picture while it decodes, in EXIF's numbers
    bool is_grey = false;
};

// The defaults where the boxes cannot be read, which libheif reports.
HeifProperties heif_properties(const std::string &path);

// EXIF's number for what rotates by `quarters` quarter turns anticlockwise, or mirrors left and right, a picture that
// `orientation` has turned already.
uint16_t turned_anticlockwise(uint16_t orientation, unsigned quarters);
uint16_t mirrored(uint16_t orientation);

}  // namespace codec

}  // namespace lensprof
