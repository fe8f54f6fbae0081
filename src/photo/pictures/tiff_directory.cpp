#include "photo/pictures/tiff_directory.hpp"
#include "photo/pictures/tiff_tags.hpp"

#include <algorithm>
#include <cstring>

namespace lensprof {

namespace {

constexpr uint32_t max_directories = 256;  // a longer chain is circular
constexpr size_t entry_bytes = 12;

}  // namespace

uint32_t tiff_type_bytes(uint16_t type) {
    constexpr uint8_t sizes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4};
    return type < sizeof sizes ? sizes[type] : 0;
}

uint32_t TiffByteOrder::get(const uint8_t *bytes, size_t size) const {
    uint32_t value = 0;
    for (size_t i = 0; i < size; ++i) value = value << 8 | bytes[big ? i : size - 1 - i];
    return value;
}

void TiffByteOrder::put(uint8_t *bytes, size_t size, uint32_t value) const {
    for (size_t i = 0; i < size; ++i) bytes[big ? size - 1 - i : i] = static_cast<uint8_t>(value >> (8 * i));
}

const TiffEntry *TiffDirectory::find(uint16_t tag) const {
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const TiffEntry &entry) { return entry.tag == tag; });
    return found == entries.end() ? nullptr : &*found;
}

TiffReader::TiffReader(uint64_t size, Read read) : size_(size), read_(std::move(read)) {
    if (size_ < tiff_header_bytes) throw UnusableTiff(TiffDefect::not_tiff);
    const std::vector<uint8_t> head = this->read(0, tiff_header_bytes);
    order_.big = head[0] == 'M';
    const uint32_t version = order_.get(&head[2], 2);
    if (head[0] != head[1] || (head[0] != 'I' && head[0] != 'M') || (version != 42 && version != 43))
        throw UnusableTiff(TiffDefect::not_tiff);
    if (version == 43) throw UnusableTiff(TiffDefect::big_tiff);
    if (order_.get(&head[4], 4) == 0) throw UnusableTiff(TiffDefect::no_directory);
}

std::vector<uint8_t> TiffReader::read(uint64_t offset, uint64_t count) {
    if (!has(offset, count)) throw UnusableTiff(TiffDefect::cut_off);
    std::vector<uint8_t> bytes(static_cast<size_t>(count));
    if (count) read_(offset, bytes.data(), bytes.size());
    return bytes;
}

TiffDirectory TiffReader::directory(uint64_t pointer) {
    TiffDirectory directory = directory_at(order_.get(read(pointer, 4).data(), 4));
    directory.pointer = pointer;
    return directory;
}

TiffDirectory TiffReader::directory_at(uint64_t offset) {
    if (++directories_ > max_directories) throw UnusableTiff(TiffDefect::circle);
    const uint32_t count = order_.get(read(offset, 2).data(), 2);
    const std::vector<uint8_t> bytes = read(offset + 2, count * entry_bytes + 4);
    TiffDirectory directory{0, offset, {}, order_.get(&bytes[count * entry_bytes], 4)};
    for (size_t position = 0; directory.entries.size() < count; position += entry_bytes) {
        TiffEntry entry{static_cast<uint16_t>(order_.get(&bytes[position], 2)),
                        static_cast<uint16_t>(order_.get(&bytes[position + 2], 2)),
                        order_.get(&bytes[position + 4], 4),
                        {},
                        offset + 2 + position + 8};
        std::memcpy(entry.value, &bytes[position + 8], 4);
        directory.entries.push_back(entry);
    }
    return directory;
}

std::vector<uint64_t> TiffReader::children(const TiffDirectory &directory) const {
    std::vector<uint64_t> children;
    const TiffEntry *entry = directory.find(tag_sub_directories);
    if (!entry || (entry->type != tiff_long && entry->type != tiff_ifd)) return children;
    if (entry->count > max_directories) throw UnusableTiff(TiffDefect::circle);
    const uint64_t first = place(*entry);
    for (uint32_t i = 0; i < entry->count; ++i) children.push_back(first + 4 * uint64_t(i));
    return children;
}

uint64_t TiffReader::place(const TiffEntry &entry) const {
    const uint64_t offset = entry.inside() ? entry.field : order_.get(entry.value, 4);
    if (!has(offset, entry.bytes())) throw UnusableTiff(TiffDefect::cut_off);
    return offset;
}

std::vector<uint8_t> TiffReader::first_bytes(const TiffEntry &entry, uint64_t count) {
    return read(place(entry), count);
}

std::vector<uint32_t> TiffReader::numbers(const TiffDirectory &directory, uint16_t tag, uint32_t max_count) {
    std::vector<uint32_t> values;
    const TiffEntry *entry = directory.find(tag);
    constexpr uint16_t integer_types[] = {tiff_byte, tiff_undefined, tiff_short, tiff_long, tiff_ifd};
    if (!entry || std::find(std::begin(integer_types), std::end(integer_types), entry->type) == std::end(integer_types))
        return values;
    const uint32_t size = tiff_type_bytes(entry->type);
    const std::vector<uint8_t> bytes = first_bytes(*entry, uint64_t(size) * std::min(entry->count, max_count));
    for (size_t i = 0; i < bytes.size(); i += size) values.push_back(order_.get(&bytes[i], size));
    return values;
}

uint32_t TiffReader::number(const TiffDirectory &directory, uint16_t tag, uint32_t fallback) {
    const std::vector<uint32_t> all = numbers(directory, tag, 1);
    return all.empty() ? fallback : all.front();
}

void TiffReader::check_blocks(const TiffDirectory &directory, uint16_t offsets_tag, uint16_t bytes_tag) {
    const std::vector<uint32_t> offsets = numbers(directory, offsets_tag), bytes = numbers(directory, bytes_tag);
    for (size_t i = 0; i < std::min(offsets.size(), bytes.size()); ++i)
        if (!has(offsets[i], bytes[i])) throw UnusableTiff(TiffDefect::pixels_cut_off);
}

void TiffReader::check_values(const TiffDirectory &directory) const {
    for (const TiffEntry &entry : directory.entries) place(entry);
}

void TiffReader::check_blocks(const TiffDirectory &directory) {
    check_blocks(directory, tag_strip_offsets, tag_strip_bytes);
    check_blocks(directory, tag_tile_offsets, tag_tile_bytes);
}

}  // namespace lensprof
