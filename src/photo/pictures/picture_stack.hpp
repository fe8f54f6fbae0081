// Files with several pictures: pages of a TIFF, slices of ImageJ and OME stacks, planes of FITS.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lensprof {

// The pictures of one file, in its order.
struct PictureStack {
    std::vector<uint32_t> pages;        // of each, for ReadOptions::page; thumbnails and masks are left out
    std::vector<uint64_t> offsets;      // of each, for ReadOptions::page_offset
    std::vector<uint32_t> channels;     // of each: the channel of the microscope, counted from 0
    std::vector<std::string> others{};  // images of FITS with another size than the first, which are left out
    uint32_t channel_count = 1;         // stated by ImageJ or OME
    bool is_damaged = false;            // further pages cannot be found: the file is truncated
};

// Other files have one page. Failure if the file cannot be opened.
PictureStack picture_stack(const std::string &path);

namespace codec {

class Tiff;

// The description of a TIFF, of ImageJ or of OME (https://docs.openmicroscopy.org/ome-model, "OME-TIFF").
struct StackDescription {
    uint32_t images = 0;  // of ImageJ: slices, which may follow the first one without pages of their own
    uint32_t channel_count = 1;
    uint32_t before_channel = 1;  // pages from one channel to the next
};

StackDescription stack_description(const Tiff &tiff);

}  // namespace codec

}  // namespace lensprof
