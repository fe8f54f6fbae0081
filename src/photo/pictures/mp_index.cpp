#include "photo/pictures/mp_index.hpp"

#include <algorithm>

#include "photo/pictures/tiff_directory.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr uint16_t tag_version = 0xb000, tag_count = 0xb001, tag_entries = 0xb002;
constexpr size_t mp_entry_bytes = 16, directory_bytes = 2 + 3 * 12 + 4;
constexpr uint32_t max_pictures = 1000;

}  // namespace

// The index is a TIFF without pixels.
std::optional<std::vector<MpPicture>> read_mp_index(const std::vector<uint8_t> &bytes) {
    try {
        TiffReader reader(bytes.size(), [&](uint64_t offset, uint8_t *to, size_t count) {
            std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), count, to);
        });
        const TiffDirectory directory = reader.first();
        const TiffEntry *entry = directory.find(tag_entries);
        if (!entry || entry->bytes() % mp_entry_bytes != 0 || entry->bytes() > max_pictures * mp_entry_bytes)
            return std::nullopt;
        const std::vector<uint8_t> entries = reader.bytes(*entry);
        if (reader.number(directory, tag_count, 0) != entries.size() / mp_entry_bytes) return std::nullopt;
        std::vector<MpPicture> pictures;
        for (size_t i = 0; i < entries.size(); i += mp_entry_bytes) {
            const auto number = [&](size_t place, size_t size) {
                return reader.order().get(&entries[i + place], size);
            };
            pictures.push_back({number(0, 4),
                                number(4, 4),
                                number(8, 4),
                                {static_cast<uint16_t>(number(12, 2)), static_cast<uint16_t>(number(14, 2))}});
        }
        return pictures;
    } catch (const UnusableTiff &) {
        return std::nullopt;
    }
}

size_t mp_segment_bytes(size_t pictures) {
    return mp_index_start + tiff_header_bytes + directory_bytes + mp_entry_bytes * pictures;
}

std::vector<uint8_t> mp_segment(const std::vector<MpPicture> &pictures) {
    std::vector<uint8_t> bytes;
    const auto put = [&](size_t value, int size) {
        for (int i = size - 1; i >= 0; --i) bytes.push_back(static_cast<uint8_t>(value >> (8 * i)));
    };
    const auto put_entry = [&](uint16_t tag, uint16_t type, size_t count, size_t value) {
        put(tag, 2), put(type, 2), put(count, 4), put(value, 4);
    };
    put(0xffe2, 2), put(mp_segment_bytes(pictures.size()) - 2, 2);
    bytes.insert(bytes.end(), {'M', 'P', 'F', 0, 'M', 'M', 0, 42});
    put(tiff_header_bytes, 4), put(3, 2);
    put_entry(tag_version, tiff_undefined, 4, 0x30313030);  // "0100"
    put_entry(tag_count, tiff_long, 1, pictures.size());
    put_entry(tag_entries, tiff_undefined, mp_entry_bytes * pictures.size(), tiff_header_bytes + directory_bytes);
    put(0, 4);
    for (const MpPicture &picture : pictures) {
        put(picture.attribute, 4), put(picture.bytes, 4), put(picture.offset, 4);
        for (const uint16_t dependent : picture.dependent) put(dependent, 2);
    }
    return bytes;
}

}  // namespace codec

}  // namespace lensprof
