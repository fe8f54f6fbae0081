// The blocks of metadata in picture files, whatever the format: EXIF, XMP, IPTC, comment and colour profile.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "photo/pictures/exif_fields.hpp"

namespace lensprof {

struct PictureBlocks {
    std::string mime_type;
    uint32_t width = 0, height = 0;
    bool is_of_camera = false;  // a file as cameras write it, with unmodified pixels: a JPEG, an HEIC, a JPEG stored in
                                // a JPEG XL

    Exif exif;
    std::vector<uint8_t> exif_block;  // as in the file, from the TIFF header on; empty if the file itself is a TIFF
    std::string xmp;                  // a packet
    std::vector<uint8_t> iptc;        // records of IPTC-IIM
    std::string comment;
    std::vector<uint8_t> icc;
};

// Throws Failure.
PictureBlocks read_blocks(const std::string &path);

// Lets `change` edit EXIF, XMP, IPTC and comment of a JPEG, PNG or TIFF, and replaces the file, completely or not at
// all. All other parts of the file stay. Throws Failure.
void edit_blocks(const std::string &path, const std::function<void(PictureBlocks &)> &change);

namespace codec {

// `count` bytes of a file from `offset` on; false if there are fewer.
using ReadAt = std::function<bool(uint64_t offset, size_t count, std::vector<uint8_t> &bytes)>;

// The readers and writers per format, in blocks_*.cpp. Files are complete, or excerpts (picture_excerpt.hpp).
// Exceptions have texts for messages.
PictureBlocks read_jpeg_blocks(const ReadAt &read);
PictureBlocks read_png_blocks(const ReadAt &read);
PictureBlocks read_tiff_blocks(const std::string &path);
std::vector<uint8_t> jpeg_with(const std::vector<uint8_t> &file, const PictureBlocks &blocks);
std::vector<uint8_t> png_with(const std::vector<uint8_t> &file, const PictureBlocks &blocks);
void write_tiff_blocks(const std::string &path, PictureBlocks blocks);

}  // namespace codec

}  // namespace lensprof
