// The pictures of a TIFF file: pages, their thumbnails and masks.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lensprof {

namespace codec {

struct TiffPages {
    std::vector<uint32_t> directories;  // that are pages
    std::vector<uint64_t> offsets;      // of these in the file
    uint32_t pages = 0;     // pictures of their own, the first included; directories that cannot be read count as pages
    bool has_more = false;  // directories beyond max_pages were not examined
    bool has_mask = false;  // a page is the mask of another one
    bool has_layers = false;  // layers of Photoshop, of which the first page is the composite
    bool is_damaged = false;  // further directories cannot be found
};

// 0 pages if the file cannot be opened; its reader reports the error. At most max_pages are examined.
TiffPages tiff_pages(const std::string &path, uint32_t max_pages = 4096);

}  // namespace codec

}  // namespace lensprof
