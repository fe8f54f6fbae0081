#include "photo/pictures/camera_correction.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <iterator>

#include "photo/pictures/exif_tags.hpp"
#include "photo/pictures/exif_value.hpp"

namespace lensprof {
namespace {

// Formats of finished pictures. A TIFF or PNG with a camera's maker notes was developed.
bool is_rendered(const std::string &mime_type) {
    static const char *const types[] = {"image/jpeg", "image/heic", "image/heif",
                                        "image/avif", "image/webp", "image/jxl"};
    return std::any_of(std::begin(types), std::end(types), [&](const char *type) { return mime_type == type; });
}

// Adobe's raw converters write their settings, and whether they were applied to the pixels.
bool has_adobe_profile(const Xmp &xmp) {
    return xmp.text(xmp_names::camera_raw, "LensProfileEnable") == "1"
           && xmp.text(xmp_names::camera_raw, "AlreadyApplied") == "True";
}

// DNG 1.7, "Opcode Lists": a count, then id, version, flags and size of each, big endian. 3 is FixVignetteRadial, 9
// GainMap. A rendered picture that still has the list was made by applying it.
bool has_falloff_opcodes(const Exif &exif) {
    for (const ExifTag tag : {exif_tags::opcode_list_2, exif_tags::opcode_list_3}) {
        const ExifField *field = exif.find(tag);
        if (!field || field->bytes.size() < 4) continue;
        const std::vector<uint8_t> &bytes = field->bytes;
        const auto word = [&](size_t offset) { return TiffByteOrder{true}.get(&bytes[offset], 4); };
        size_t offset = 4;
        for (uint32_t i = 0; i < word(0) && offset + 16 <= bytes.size(); i++) {
            if (word(offset) == 3 || word(offset) == 9) return true;
            offset += size_t(16) + word(offset + 12);
        }
    }
    return false;
}

}  // namespace

bool is_of_converter(const Exif &exif, const Xmp &xmp) {
    static const char *const names[] = {"darktable", "rawtherapee", "ufraw",       "dcraw", "libraw",
                                        "lightroom", "camera raw",  "capture one", "dxo",   "on1 ",
                                        "luminar",   "rawstudio",   "lensprof"};
    if (xmp.has(xmp_names::camera_raw, "RawFileName")) return true;
    std::string software = read_text(exif, exif_tags::software);
    for (char &c : software) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return std::any_of(std::begin(names), std::end(names),
                       [&](const char *name) { return software.find(name) != std::string::npos; });
}

std::string falloff_corrected_by(const PictureBlocks &blocks, const Xmp &xmp, const std::string &by_camera,
                                 const lensprof_profile_key &key) {
    if (has_adobe_profile(xmp)) return "by the raw converter (Adobe: lens profile)";
    if (!blocks.exif.find(exif_tags::dng_version) && has_falloff_opcodes(blocks.exif))
        return "by the raw converter (opcodes of DNG)";
    if (!is_rendered(blocks.mime_type) || is_of_converter(blocks.exif, xmp)) return {};
    if (!by_camera.empty()) return "in camera (" + by_camera + ")";
    lensprof_profile_key jpeg = key;
    jpeg.processing = LENSPROF_PROCESSING_JPEG;
    return lensprof_camera_kind_of(&jpeg) == LENSPROF_CAMERA_PHONE ? "in camera (a phone)" : std::string();
}

}  // namespace lensprof
