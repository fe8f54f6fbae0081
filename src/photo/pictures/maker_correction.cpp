#include "photo/pictures/maker_correction.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace lensprof {
namespace {

std::optional<long> read_integer(const Exiv2::ExifData &exif, const char *key) {
    const auto datum = exif.findKey(Exiv2::ExifKey(key));
    if (datum == exif.end() || datum->count() == 0) return std::nullopt;
    return datum->toLong();
}

// A value as raw bytes of the file, whatever its type.
class NoteField {
public:
    NoteField(const MakerExif &exif, const char *key) : little_(exif.order == Exiv2::littleEndian) {
        const auto datum = exif.data.findKey(Exiv2::ExifKey(key));
        if (datum == exif.data.end() || datum->size() <= 0) return;
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
bool canon_corrects(const MakerExif &exif) {
    const NoteField done(exif, "Exif.Canon.0x4015");
    if (done.size() >= 6 && done.number_at(0, 1) == 0 && done.number_at(0, 4) != 0) return done.number_at(4, 2) == 1;
    return NoteField(exif, "Exif.Canon.0x4016").number_at(20, 4) == 1
           || NoteField(exif, "Exif.Canon.0x4018").number_at(4, 4) == 1;
}

}  // namespace

std::string correction_in_notes(const MakerExif &exif) {
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
        const auto value = read_integer(exif.data, entry.key);
        if (value && std::count(entry.on.begin(), entry.on.end(), *value)) return entry.name;
    }
    if (canon_corrects(exif)) return "Canon: peripheral illumination correction";
    if (NoteField(exif, "Exif.Pentax.0x007d").number_at(2, 1) == 1) return "Pentax: peripheral illumination correction";
    return {};
}

}  // namespace lensprof
