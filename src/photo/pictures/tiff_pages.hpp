// The pictures of a TIFF file: pages, their thumbnails and masks.
#pragma once

#include <cstdint>
#include <string>

namespace lensprof {

namespace codec {

struct TiffPages {
    uint32_t pages = 0;     // pictures of their own, the first included; directories that cannot be read count as pages
    bool has_more = false;  // further directories were not examined
    bool has_mask = false;  // a page is the mask of another one
    bool has_layers = false;  // layers of Photoshop, of which the first page is the composite
    bool is_damaged = false;  // further directories cannot be found
};

// 0 pages if the file cannot be opened; its reader reports the error.
TiffPages tiff_pages(const std::string &path);

}  // namespace codec

}  // namespace lensprof
