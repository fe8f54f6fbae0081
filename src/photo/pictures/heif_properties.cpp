// ISO/IEC 14496-12 (boxes; 8.11.4 pitm, 8.11.14 iprp), 14496-15 (8.3.3 hvcC) and 23008-12 (6.5.6 pixi, 6.5.10
// irot, 6.5.12 imir), AV1-ISOBMFF (2.3 av1C). All numbers are big-endian.
#include "photo/pictures/heif_properties.hpp"

#include <array>
#include <cstring>
#include <optional>
#include <vector>

#include "photo/pictures/codec.hpp"
#include "photo/pictures/file_boxes.hpp"
#include "photo/pictures/picture_excerpt.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr uint64_t max_meta_bytes = uint64_t(64) << 20;

// Reads bytes from the front. Beyond the end it returns zeros and sets `is_short`.
struct Bytes {
    const uint8_t *data = nullptr;
    size_t count = 0;
    bool is_short = false;

    uint64_t number(size_t bytes) {
        if (count < bytes) {
            is_short = true;
            count = 0;
            return 0;
        }
        uint64_t value = 0;
        for (size_t i = 0; i < bytes; i++) value = value << 8 | data[i];
        skip(bytes);
        return value;
    }

    void skip(size_t bytes) {
        data += bytes;
        count -= bytes;
    }
};

struct Box {
    std::array<char, 4> type;
    Bytes content;

    bool is(const char *name) const { return std::memcmp(type.data(), name, 4) == 0; }
};

std::optional<Box> next_box(Bytes &bytes) {
    Bytes rest = bytes;
    uint64_t size = rest.number(4);
    Box box{};
    for (char &c : box.type) c = static_cast<char>(rest.number(1));
    if (size == 1) size = rest.number(8);
    if (size == 0) size = bytes.count;
    const size_t head = bytes.count - rest.count;
    if (rest.is_short || size < head || size > bytes.count) return std::nullopt;
    box.content = {rest.data, static_cast<size_t>(size) - head};
    bytes.skip(static_cast<size_t>(size));
    return box;
}

std::optional<Box> find_box(Bytes bytes, const char *type) {
    while (const auto box = next_box(bytes))
        if (box->is(type)) return box;
    return std::nullopt;
}

// The content of the file's meta box; empty if not found.
std::vector<uint8_t> read_meta(const std::string &path) {
    const File file = open_for_reading(path);
    std::vector<uint8_t> meta;
    each_box(file.get(), [&](const std::string &type, uint64_t start, uint64_t size) {
        if (type != "meta") return true;
        if (size > max_meta_bytes || !read_at(file.get(), start, static_cast<size_t>(size), meta)) meta.clear();
        return false;
    });
    return meta;
}

// 14496-12, 8.11.6: whether an item of this type is listed.
bool has_item(Bytes meta, const char *type) {
    const auto items = find_box(meta, "iinf");
    if (!items) return false;
    Bytes rest = items->content;
    rest.number(rest.number(4) >> 24 == 0 ? 2 : 4);  // version, and the number of items
    while (const auto item = next_box(rest)) {
        Bytes entry = item->content;
        const uint64_t version = entry.number(4) >> 24;
        entry.number(version < 3 ? 2 : 4), entry.number(2);
        if (version >= 2 && entry.count >= 4 && std::memcmp(entry.data, type, 4) == 0) return true;
    }
    return false;
}

// 1-based indices of an item's properties, in order.
std::vector<size_t> properties_of(uint64_t item, Bytes ipma) {
    const uint64_t version = ipma.number(1), flags = ipma.number(3), entries = ipma.number(4);
    std::vector<size_t> properties;
    for (uint64_t i = 0; i < entries && !ipma.is_short; i++) {
        const uint64_t id = ipma.number(version < 1 ? 2 : 4), count = ipma.number(1);
        for (uint64_t k = 0; k < count; k++) {
            const uint64_t number = flags & 1 ? ipma.number(2) & 0x7fff : ipma.number(1) & 0x7f;
            if (id == item && !ipma.is_short) properties.push_back(static_cast<size_t>(number));
        }
    }
    return properties;
}

// Whether a property states that there is one channel.
bool states_grey(const Box &box) {
    Bytes content = box.content;
    if (box.is("pixi")) return content.number(4) == 0 && content.number(1) == 1;
    if (box.is("hvcC")) return content.count > 16 && (content.data[16] & 3) == 0;  // chroma_format
    return box.is("av1C") && content.count > 2 && (content.data[2] & 0x10) != 0;   // monochrome
}

HeifProperties combine(const std::vector<Box> &properties, const std::vector<size_t> &indices) {
    HeifProperties combined;
    uint16_t &orientation = combined.orientation;
    for (const size_t number : indices) {
        if (number == 0 || number > properties.size()) continue;
        Box box = properties[number - 1];
        combined.is_grey |= states_grey(box);
        if (box.is("irot")) orientation = rotated_anticlockwise(orientation, box.content.number(1) & 3);
        if (!box.is("imir")) continue;
        orientation = mirrored(orientation);
        // 0: the axis is upright, as libheif takes it; 1: it lies, which is a half turn more
        if (box.content.number(1) & 1) orientation = rotated_anticlockwise(orientation, 2);
    }
    return combined;
}

}  // namespace

// EXIF orientations as optional mirroring left and right (2, 4, 5, 7) followed by a clockwise rotation of 0, 90, 180 or
// 270 degrees.
uint16_t rotated_anticlockwise(uint16_t orientation, unsigned quarters) {
    static constexpr uint16_t plain[] = {1, 8, 3, 6}, mirror[] = {2, 5, 4, 7};
    for (const auto &circle : {plain, mirror})
        for (unsigned i = 0; i < 4; i++)
            if (circle[i] == orientation) return circle[(i + quarters) % 4];
    return orientation;
}

uint16_t mirrored(uint16_t orientation) {
    static constexpr uint16_t other[] = {1, 2, 1, 4, 3, 6, 5, 8, 7};
    return orientation < 9 ? other[orientation] : orientation;
}

HeifProperties heif_properties(const std::string &path) {
    const std::vector<uint8_t> bytes = read_meta(path);
    Bytes meta{bytes.data(), bytes.size()};
    meta.number(4);  // version and flags
    const auto pitm = find_box(meta, "pitm"), iprp = find_box(meta, "iprp");
    if (!pitm || !iprp) return {};
    Bytes primary = pitm->content;
    const uint64_t version = primary.number(1);
    primary.number(3);
    const uint64_t item = primary.number(version == 0 ? 2 : 4);
    const auto ipco = find_box(iprp->content, "ipco");
    if (!ipco || primary.is_short) return {};
    std::vector<Box> properties;
    Bytes rest = ipco->content;
    while (const auto box = next_box(rest)) properties.push_back(*box);
    rest = iprp->content;
    while (const auto box = next_box(rest)) {  // there may be several ipma
        if (!box->is("ipma")) continue;
        const std::vector<size_t> indices = properties_of(item, box->content);
        if (!indices.empty()) return combine(properties, indices);
    }
    return {};
}

HeifContents heif_contents(const std::string &path) {
    HeifContents contents;
    const File file = open_for_reading(path);
    each_box(file.get(), [&](const std::string &type, uint64_t, uint64_t) {
        contents.has_frames |= type == "moov";
        contents.has_video |= type == "mpvd";
        return true;
    });
    const std::vector<uint8_t> bytes = read_meta(path);
    Bytes meta{bytes.data(), bytes.size()};
    meta.number(4);  // version and flags
    contents.has_tone_map = has_item(meta, "tmap");
    return contents;
}

}  // namespace codec

}  // namespace lensprof
