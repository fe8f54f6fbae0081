#include "photo/pictures/camera_correction.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <optional>
#include <vector>

#include <exiv2/exiv2.hpp>

namespace lensprof {
namespace {

std::optional<long> read_integer(const Exiv2::ExifData &exif, const char *key) {
    const auto datum = exif.findKey(Exiv2::ExifKey(key));
    if (datum == exif.end() || datum->count() == 0) return std::nullopt;
    return datum->toLong();
}

// A value as raw bytes of the file, whatever its type.
class Block {
public:
    Block(const Exiv2::Image &image, const char *key) : little_(image.byteOrder() == Exiv2::littleEndian) {
        const auto datum = image.exifData().findKey(Exiv2::ExifKey(key));
        if (datum == image.exifData().end() || datum->size() <= 0) return;
        bytes_.resize(static_cast<size_t>(datum->size()));
        datum->copy(bytes_.data(), little_ ? Exiv2::littleEndian : Exiv2::bigEndian);
    }

    size_t size() const { return bytes_.size(); }

    // Unsigned, `count` bytes starting at `offset`; 0 beyond the end.
    uint32_t number_at(size_t offset, size_t count) const {
        uint32_t value = 0;
        if (offset + count > bytes_.size()) return 0;
        for (size_t i = 0; i < count; i++) value = value << 8 | bytes_[little_ ? offset + count - 1 - i : offset + i];
        return value;
    }

private:
    bool little_;
    std::vector<uint8_t> bytes_;
};

// Tags 0x4015 (what was done: version 0 has a size in its second word and the switch in its third), else 0x4016 and
// 0x4018 (the menu setting, the sixth and the second word of four bytes), as documented by ExifTool.
bool canon_corrects(const Exiv2::Image &image) {
    const Block done(image, "Exif.Canon.0x4015");
    if (done.size() >= 6 && done.number_at(0, 1) == 0 && done.number_at(0, 4) != 0) return done.number_at(4, 2) == 1;
    return Block(image, "Exif.Canon.0x4016").number_at(20, 4) == 1
           || Block(image, "Exif.Canon.0x4018").number_at(4, 4) == 1;
}

std::string maker_notes(const Exiv2::Image &image) {
    const Exiv2::ExifData &exif = image.exifData();
    static const struct {
        const char *key;
        std::vector<long> on;
        const char *name;
    } switches[] = {
        {"Exif.Sony1.0x2011", {2}, "Sony: vignetting correction"},
        {"Exif.Sony2.0x2011", {2}, "Sony: vignetting correction"},
        {"Exif.OlympusIp.ShadingCompensation", {1}, "Olympus: shading compensation"},
        {"Exif.OlympusCs.ShadingCompensation", {1}, "Olympus: shading compensation"},
        {"Exif.Panasonic.ShadingCompensation", {1}, "Panasonic: shading compensation"},
        {"Exif.Nikon3.VignetteControl", {1, 3, 5}, "Nikon: vignette control"},
    };
    for (const auto &entry : switches) {
        const auto value = read_integer(exif, entry.key);
        if (value && std::count(entry.on.begin(), entry.on.end(), *value)) return entry.name;
    }
    if (canon_corrects(image)) return "Canon: peripheral illumination correction";
    if (Block(image, "Exif.Pentax.0x007d").number_at(2, 1) == 1) return "Pentax: peripheral illumination correction";
    return {};
}

// Formats of finished pictures. A TIFF or PNG with a camera's maker notes was developed.
bool is_rendered(const Exiv2::Image &image) {
    static const char *const types[] = {"image/jpeg", "image/heic", "image/heif",
                                        "image/avif", "image/webp", "image/jxl"};
    const std::string mime_type = image.mimeType();
    return std::any_of(std::begin(types), std::end(types), [&](const char *type) { return mime_type == type; });
}

// Adobe's raw converters write their settings, and whether they were applied to the pixels.
bool has_adobe_profile(const Exiv2::XmpData &xmp) {
    const auto is = [&](const char *key, const char *value) {
        const auto datum = xmp.findKey(Exiv2::XmpKey(key));
        return datum != xmp.end() && datum->toString() == value;
    };
    return is("Xmp.crs.LensProfileEnable", "1") && is("Xmp.crs.AlreadyApplied", "True");
}

// DNG 1.7, "Opcode Lists": a count, then id, version, flags and size of each, big endian. 3 is FixVignetteRadial, 9
// GainMap. A rendered picture that still has the list was made by applying it.
bool has_falloff_opcodes(const Exiv2::ExifData &exif) {
    for (const char *key : {"Exif.Image.OpcodeList2", "Exif.Image.OpcodeList3"}) {
        const auto datum = exif.findKey(Exiv2::ExifKey(key));
        if (datum == exif.end() || datum->size() < 4) continue;
        std::vector<uint8_t> bytes(static_cast<size_t>(datum->size()));
        datum->copy(bytes.data(), Exiv2::bigEndian);
        const auto word = [&](size_t offset) {
            return uint32_t(bytes[offset]) << 24 | uint32_t(bytes[offset + 1]) << 16 | uint32_t(bytes[offset + 2]) << 8
                   | bytes[offset + 3];
        };
        size_t offset = 4;
        for (uint32_t i = 0; i < word(0) && offset + 16 <= bytes.size(); i++) {
            if (word(offset) == 3 || word(offset) == 9) return true;
            offset += size_t(16) + word(offset + 12);
        }
    }
    return false;
}

}  // namespace

bool is_of_converter(const Exiv2::Image &image) {
    static const char *const names[] = {"darktable", "rawtherapee", "ufraw",       "dcraw", "libraw",
                                        "lightroom", "camera raw",  "capture one", "dxo",   "on1 ",
                                        "luminar",   "rawstudio",   "lensprof"};
    if (image.xmpData().findKey(Exiv2::XmpKey("Xmp.crs.RawFileName")) != image.xmpData().end()) return true;
    const auto datum = image.exifData().findKey(Exiv2::ExifKey("Exif.Image.Software"));
    if (datum == image.exifData().end()) return false;
    std::string software = datum->toString();
    for (char &c : software) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return std::any_of(std::begin(names), std::end(names),
                       [&](const char *name) { return software.find(name) != std::string::npos; });
}

std::string falloff_corrected_by(const Exiv2::Image &image, const lensprof_profile_key &key) {
    const Exiv2::ExifData &exif = image.exifData();
    if (has_adobe_profile(image.xmpData())) return "by the raw converter (Adobe: lens profile)";
    const bool is_dng = exif.findKey(Exiv2::ExifKey("Exif.Image.DNGVersion")) != exif.end();
    if (!is_dng && has_falloff_opcodes(exif)) return "by the raw converter (opcodes of DNG)";
    if (!is_rendered(image) || is_of_converter(image)) return {};
    const std::string note = maker_notes(image);
    if (!note.empty()) return "in camera (" + note + ")";
    lensprof_profile_key jpeg = key;
    jpeg.processing = LENSPROF_PROCESSING_JPEG;
    return lensprof_camera_kind_of(&jpeg) == LENSPROF_CAMERA_PHONE ? "in camera (a phone)" : std::string();
}

}  // namespace lensprof
