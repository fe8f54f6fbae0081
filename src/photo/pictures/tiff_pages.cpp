#include "photo/pictures/tiff_pages.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "photo/pictures/tiff_handle.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr uint32_t max_children = 256;  // examined
constexpr uint32_t thumbnail_max_side = 320;

// TIFF 6.0, tag 254, and Exif 2.32, 4.5.5: the second of two directories is a thumbnail, without a mark of its own.
enum class PageKind {
    page,
    reduced,
    mask
};

// `first_side`: of the picture that a directory without a mark may be a thumbnail of; 0 = of none.
PageKind kind_of(const Tiff &tiff, uint32_t first_side) {
    const uint32_t type = tiff.field<uint32_t>(TIFFTAG_SUBFILETYPE, 0);
    if (type & FILETYPE_MASK) return PageKind::mask;
    if (type & FILETYPE_REDUCEDIMAGE) return PageKind::reduced;
    const uint32_t side =
        std::max(tiff.field<uint32_t>(TIFFTAG_IMAGEWIDTH, 0), tiff.field<uint32_t>(TIFFTAG_IMAGELENGTH, 0));
    const bool is_thumbnail = type == 0 && side <= thumbnail_max_side && side <= first_side / 2;
    return is_thumbnail ? PageKind::reduced : PageKind::page;
}

void count(PageKind kind, TiffPages &pages) {
    pages.pages += kind == PageKind::page;
    pages.has_mask |= kind == PageKind::mask;
}

// Adobe Photoshop TIFF Technical Notes: blocks "8BIM" (in the byte order of the file), one of which holds the layers.
bool has_layers(const Tiff &tiff) {
    uint32_t bytes = 0;
    const char *data = nullptr;
    if (!TIFFGetField(tiff.handle, TIFFTAG_IMAGESOURCEDATA, &bytes, &data) || !data) return false;
    const std::string_view blocks(data, std::min<uint32_t>(bytes, 1 << 16));
    for (const std::string_view name : {"Layr", "Lr16", "Lr32", "ryaL", "61rL", "23rL"})
        if (blocks.find(name) != std::string_view::npos) return true;
    return false;
}

// The directories within the first one, each once: more than max_children are damage.
std::vector<uint64_t> children_of(const Tiff &tiff) {
    uint16_t children = 0;
    const uint64_t *offsets = nullptr;
    if (!TIFFGetField(tiff.handle, TIFFTAG_SUBIFD, &children, &offsets) || !offsets) return {};
    std::vector<uint64_t> distinct(offsets, offsets + children);
    std::sort(distinct.begin(), distinct.end());
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    if (distinct.size() > max_children) distinct.resize(max_children);
    return distinct;
}

}  // namespace

TiffPages tiff_pages(const std::string &path, uint32_t max_pages) {
    Tiff tiff(path, "rm");
    TiffPages pages;
    if (!tiff.handle) return pages;
    pages.pages = 1;
    pages.directories = {0}, pages.offsets = {TIFFCurrentDirOffset(tiff.handle)};
    pages.has_layers = has_layers(tiff);
    const std::vector<uint64_t> children = children_of(tiff);
    const uint32_t first_side =
        std::max(tiff.field<uint32_t>(TIFFTAG_IMAGEWIDTH, 0), tiff.field<uint32_t>(TIFFTAG_IMAGELENGTH, 0));
    tiff.message = {};
    const uint32_t all = TIFFNumberOfDirectories(tiff.handle), directories = std::min(all, max_pages);
    pages.has_more = all > max_pages;
    pages.is_damaged = tiff.failed();
    const bool may_be_exif = directories == 2;
    for (uint32_t i = 1; i < directories; ++i) {
        const uint32_t before = pages.pages;
        if (TIFFReadDirectory(tiff.handle))
            count(kind_of(tiff, may_be_exif ? first_side : 0), pages);
        else if (!may_be_exif)  // a thumbnail of EXIF states no size
            count(PageKind::page, pages);
        if (pages.pages == before) continue;
        pages.directories.push_back(i), pages.offsets.push_back(TIFFCurrentDirOffset(tiff.handle));
    }
    for (const uint64_t child : children)
        if (TIFFSetSubDirectory(tiff.handle, child)) count(kind_of(tiff, first_side), pages);
    return pages;
}

}  // namespace codec

}  // namespace lensprof
