#include "photo/pictures/part_tags.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "photo/pictures/tiff_directory.hpp"

namespace lensprof {

namespace codec {

namespace {

// Of a property whose namespace is registered, as all of a packet that was read are. Fields of a structure have the
// namespace of the structure.
std::string namespace_of(const Exiv2::Xmpdatum &datum) {
    try {
        return Exiv2::XmpProperties::ns(datum.groupName());
    } catch (const Exiv2::Error &) {
        return {};
    }
}

void remove_if(Exiv2::XmpData &xmp, const std::function<bool(const Exiv2::Xmpdatum &)> &is_removed) {
    Exiv2::XmpData kept;
    for (const Exiv2::Xmpdatum &datum : xmp)
        if (!is_removed(datum)) kept.add(datum);
    xmp = kept;
}

template <size_t count>
bool is_one_of(const std::string &text, const char *const (&all)[count]) {
    return std::find(std::begin(all), std::end(all), text) != std::end(all);
}

constexpr uint16_t apple_headroom = 0x0021, apple_gain = 0x0030;

bool is_gain_map_tag(uint32_t tag) { return tag == apple_headroom || tag == apple_gain; }

// A maker note that Exiv2 copies as bytes: "Apple iOS", a version, "MM" and a directory, whose offsets are those in the
// note. Moves the other entries together; their values stay in place.
bool edit_apple_note(std::vector<uint8_t> &note) {
    constexpr char mark[] = "Apple iOS";
    constexpr size_t directory = 14, entry_bytes = 12;
    if (note.size() < directory + 2 || std::memcmp(note.data(), mark, sizeof mark) != 0 || note[12] != 'M')
        return false;
    const TiffByteOrder order{true};
    const size_t count = order.get(&note[directory], 2);
    if ((note.size() - directory - 2) / entry_bytes < count) return false;
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
        const size_t entry = directory + 2 + entry_bytes * i;
        if (is_gain_map_tag(order.get(&note[entry], 2))) continue;
        std::memmove(&note[directory + 2 + entry_bytes * kept++], &note[entry], entry_bytes);
    }
    if (kept == count) return false;
    const size_t end = directory + 2 + entry_bytes * count, new_end = directory + 2 + entry_bytes * kept;
    std::fill(note.begin() + static_cast<std::ptrdiff_t>(new_end), note.begin() + static_cast<std::ptrdiff_t>(end), 0);
    order.put(&note[directory], 2, static_cast<uint32_t>(kept));
    return true;
}

}  // namespace

void remove_part_tags(Exiv2::XmpData &xmp) {
    static const char *const namespaces[] = {
        "http://ns.google.com/photos/1.0/container/", "http://ns.google.com/photos/dd/1.0/device/",
        "http://ns.adobe.com/hdr-gain-map/1.0/", "http://ns.apple.com/HDRGainMap/1.0/",
        "http://ns.apple.com/pixeldatainfo/1.0/"};
    remove_if(xmp, [](const Exiv2::Xmpdatum &datum) {
        const std::string tag = datum.tagName();
        return is_one_of(namespace_of(datum), namespaces) || tag.rfind("MotionPhoto", 0) == 0
               || tag.rfind("MicroVideo", 0) == 0;
    });
}

void remove_extended_tags(Exiv2::XmpData &xmp) {
    static const char *const namespaces[] = {"http://ns.google.com/photos/1.0/depthmap/",
                                             "http://ns.google.com/photos/1.0/image/",
                                             "http://ns.google.com/photos/1.0/audio/"};
    const bool is_extended = std::any_of(xmp.begin(), xmp.end(), [](const Exiv2::Xmpdatum &datum) {
        return datum.key() == "Xmp.xmpNote.HasExtendedXMP";
    });
    if (!is_extended) return;
    remove_if(xmp, [](const Exiv2::Xmpdatum &datum) { return is_one_of(namespace_of(datum), namespaces); });
}

void remove_gain_map_tags(Exiv2::ExifData &exif) {
    for (auto datum = exif.begin(); datum != exif.end();)
        datum = datum->groupName() == "Apple" && is_gain_map_tag(datum->tag()) ? exif.erase(datum) : std::next(datum);
    const auto found = exif.findKey(Exiv2::ExifKey("Exif.Photo.MakerNote"));
    if (found == exif.end()) return;
    std::vector<uint8_t> note(static_cast<size_t>(found->size()));
    found->copy(note.data(), Exiv2::bigEndian);
    if (!edit_apple_note(note)) return;
    Exiv2::DataValue value(note.data(), static_cast<long>(note.size()));
    found->setValue(&value);
}

}  // namespace codec

}  // namespace lensprof
