#include "cli/pictures/opcode_tag.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>

#include <lensprof/apply.h>

#include "cli/program/error.hpp"
#include "cli/program/output_file.hpp"

namespace lensprof {

namespace {

constexpr uint16_t tag_subfile_type = 254, tag_width = 256, tag_height = 257, tag_photometric = 262,
                   tag_strip_offsets = 273, tag_samples = 277, tag_strip_bytes = 279, tag_tile_offsets = 324,
                   tag_tile_bytes = 325, tag_sub_ifds = 330, tag_cfa_repeat = 33421, tag_cfa_pattern = 33422,
                   tag_active_area = 50829;
constexpr uint32_t photometric_cfa = 32803, photometric_linear_raw = 34892;
constexpr uint16_t type_byte = 1, type_short = 3, type_long = 4, type_undefined = 7, type_ifd = 13;
constexpr size_t most_directories = 256;  // a chain that is longer leads in a circle
constexpr uint32_t most_opcode_bytes = 64u << 20;

struct Entry {
    uint16_t tag, type;
    uint32_t count;
    uint8_t value[4];  // or its offset, as in the file
};

struct Directory {
    uint64_t pointer;  // place in the file of the offset that leads here
    std::vector<Entry> entries;
    uint32_t next;  // offset of the next directory of the chain
};

// The directories of a classic TIFF. Reads what it is asked for and nothing else.
class TiffFile {
public:
    explicit TiffFile(const std::string &path) : path_(path), file_(path, std::ios::binary) {
        if (!file_) fail("cannot be opened: " + system_text(errno) + "; check the name and its permissions");
        file_.seekg(0, std::ios::end);
        size_ = static_cast<uint64_t>(std::max<std::streamoff>(file_.tellg(), 0));
        uint8_t head[8] = {0};
        if (size_ >= sizeof head) read(0, head, sizeof head);
        big_endian_ = head[0] == 'M';
        if (!(head[0] == head[1] && (head[0] == 'I' || head[0] == 'M')) || (u16(head + 2) != 42 && u16(head + 2) != 43))
            fail("is not a TIFF or DNG file; give one, since opcodes belong into these only");
        if (u16(head + 2) == 43) fail("is a BigTIFF, which has no opcodes in lensprof; convert it to classic TIFF");
        if (u32(head + 4) == 0) fail("has no directory; give a complete file");
    }

    uint64_t size() const { return size_; }

    // That of the raw image; in a plain TIFF the first. *raw receives which. Its values and pixels are all there.
    Directory find_raw(bool *raw) {
        Directory found = choose(raw);
        for (const Entry &entry : found.entries) value_of(entry, size_of(entry.type), 0);
        check_blocks(found, tag_strip_offsets, tag_strip_bytes);
        check_blocks(found, tag_tile_offsets, tag_tile_bytes);
        return found;
    }

    // The first number of a tag.
    uint32_t number(const Directory &directory, uint16_t tag, uint32_t otherwise) {
        const std::vector<uint32_t> all = numbers(directory, tag, 1);
        return all.empty() ? otherwise : all.front();
    }

    // At most `most` numbers of a tag of bytes, shorts or longs; none where it is missing.
    std::vector<uint32_t> numbers(const Directory &directory, uint16_t tag, uint32_t most) {
        std::vector<uint32_t> values;
        const Entry *entry = find(directory, tag);
        const bool whole = entry
                           && (entry->type == type_byte || entry->type == type_undefined || entry->type == type_short
                               || entry->type == type_long || entry->type == type_ifd);
        if (!whole) return values;
        const uint32_t size = size_of(entry->type);
        const std::vector<uint8_t> bytes = value_of(*entry, size, std::min(entry->count, most));
        for (size_t i = 0; i < bytes.size(); i += size)
            values.push_back(size == 1 ? bytes[i] : size == 2 ? u16(&bytes[i]) : u32(&bytes[i]));
        return values;
    }

    std::vector<uint8_t> bytes_of(const Directory &directory, uint16_t tag) {
        const Entry *entry = find(directory, tag);
        if (!entry || (entry->type != type_undefined && entry->type != type_byte)) return {};
        if (entry->count > most_opcode_bytes) fail("has an opcode list of over 64 MiB; give another file");
        return value_of(*entry, 1, entry->count);
    }

    void put_u16(std::vector<uint8_t> &bytes, uint32_t value) const { put(bytes, value, 2); }
    void put_u32(std::vector<uint8_t> &bytes, uint32_t value) const { put(bytes, value, 4); }

    // All of it, in pieces.
    void copy_to(std::ostream &target) {
        std::vector<char> piece(1 << 20);
        file_.clear();
        file_.seekg(0);
        for (uint64_t left = size_; left;) {
            const size_t bytes = static_cast<size_t>(std::min<uint64_t>(left, piece.size()));
            if (!file_.read(piece.data(), static_cast<std::streamsize>(bytes)))
                fail("cannot be read to its end: " + system_text(errno) + "; check the disk");
            target.write(piece.data(), static_cast<std::streamsize>(bytes));
            left -= bytes;
        }
    }

private:
    [[noreturn]] void fail(const std::string &text) const { throw Failure(ExitCode::unreadable, path_ + ": " + text); }

    uint32_t u16(const uint8_t *b) const { return big_endian_ ? b[0] << 8 | b[1] : b[1] << 8 | b[0]; }

    uint32_t u32(const uint8_t *b) const { return big_endian_ ? u16(b) << 16 | u16(b + 2) : u16(b + 2) << 16 | u16(b); }

    void put(std::vector<uint8_t> &bytes, uint32_t value, int size) const {
        for (int i = 0; i < size; ++i)
            bytes.push_back(static_cast<uint8_t>(value >> 8 * (big_endian_ ? size - 1 - i : i)));
    }

    void read(uint64_t offset, void *bytes, size_t count) {
        if (offset > size_ || count > size_ - offset)
            fail("ends before what its directory has; give the complete file");
        file_.clear();
        file_.seekg(static_cast<std::streamoff>(offset));
        if (count && !file_.read(static_cast<char *>(bytes), static_cast<std::streamsize>(count)))
            fail("cannot be read: " + system_text(errno) + "; check the disk");
    }

    Directory read_directory(uint64_t pointer, uint64_t &seen) {
        if (++seen > most_directories) fail("has directories that lead in a circle, or over 256; give another file");
        uint8_t word[4];
        read(pointer, word, 4);
        const uint64_t offset = u32(word);
        read(offset, word, 2);
        const uint32_t count = u16(word);
        std::vector<uint8_t> bytes(size_t(count) * 12 + 4);
        read(offset + 2, bytes.data(), bytes.size());
        Directory directory{pointer, {}, u32(&bytes[size_t(count) * 12])};
        for (const uint8_t *b = bytes.data(); directory.entries.size() < count; b += 12) {
            Entry entry{static_cast<uint16_t>(u16(b)), static_cast<uint16_t>(u16(b + 2)), u32(b + 4), {}};
            std::memcpy(entry.value, b + 8, 4);
            directory.entries.push_back(entry);
        }
        return directory;
    }

    // Place of the offset of the next directory: of the directory read just now, or before its children.
    uint64_t next_pointer(const Directory &directory) {
        uint8_t word[4];
        read(directory.pointer, word, 4);
        return uint64_t(u32(word)) + 2 + directory.entries.size() * 12;
    }

    std::vector<Directory> read_children(const Directory &directory, uint64_t &seen) {
        std::vector<Directory> children;
        const Entry *entry = find(directory, tag_sub_ifds);
        if (!entry || (entry->type != type_long && entry->type != type_ifd)) return children;
        if (entry->count > most_directories) fail("has over 256 directories; give another file");
        uint8_t word[4];
        read(directory.pointer, word, 4);
        const uint64_t inside =
            uint64_t(u32(word)) + 2 + static_cast<uint64_t>(entry - directory.entries.data()) * 12 + 8;
        const uint64_t first = entry->count == 1 ? inside : u32(entry->value);
        for (uint32_t i = 0; i < entry->count; ++i) children.push_back(read_directory(first + 4 * uint64_t(i), seen));
        return children;
    }

    Directory choose(bool *raw) {
        std::optional<Directory> preview, first;
        for (uint64_t pointer = 4, seen = 0; pointer;) {
            Directory directory = read_directory(pointer, seen);
            std::vector<Directory> family = read_children(directory, seen);
            pointer = directory.next ? next_pointer(directory) : 0;
            family.insert(family.begin(), std::move(directory));
            if (!first) first = family.front();
            for (Directory &one : family)
                if (is_raw(one) && number(one, tag_subfile_type, 0) == 0) {
                    *raw = true;
                    return std::move(one);
                } else if (is_raw(one) && !preview) {
                    preview = std::move(one);
                }
        }
        *raw = preview.has_value();
        return preview ? *preview : *first;
    }

    // Bytes of a value of a type; 0 for types that there are not.
    static uint32_t size_of(uint16_t type) {
        constexpr uint8_t sizes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4};
        return type < sizeof sizes ? sizes[type] : 0;
    }

    // Strips or tiles.
    void check_blocks(const Directory &directory, uint16_t offsets_tag, uint16_t bytes_tag) {
        const std::vector<uint32_t> offsets = numbers(directory, offsets_tag, UINT32_MAX),
                                    bytes = numbers(directory, bytes_tag, UINT32_MAX);
        for (size_t i = 0; i < std::min(offsets.size(), bytes.size()); ++i)
            if (uint64_t(offsets[i]) + bytes[i] > size_)
                fail("ends before the pixels that its directory has; give the complete file");
    }

    static const Entry *find(const Directory &directory, uint16_t tag) {
        for (const Entry &entry : directory.entries)
            if (entry.tag == tag) return &entry;
        return nullptr;
    }

    bool is_raw(const Directory &directory) {
        const uint32_t photometric = number(directory, tag_photometric, 0);
        return photometric == photometric_cfa || photometric == photometric_linear_raw;
    }

    // The first `count` of an entry's values, all of which must be in the file.
    std::vector<uint8_t> value_of(const Entry &entry, uint32_t size, uint32_t count) {
        const uint64_t whole = uint64_t(entry.count) * size;
        std::vector<uint8_t> bytes;
        if (whole <= 4) {
            bytes.assign(entry.value, entry.value + size_t(count) * size);
            return bytes;
        }
        const uint64_t offset = u32(entry.value);
        if (offset > size_ || whole > size_ - offset)
            fail("ends before what its directory has; give the complete file");
        bytes.resize(size_t(count) * size);
        read(offset, bytes.data(), bytes.size());
        return bytes;
    }

    std::string path_;
    std::ifstream file_;
    uint64_t size_ = 0;
    bool big_endian_ = false;
};

// Channels of the first 2 x 2 pixels, 0 red, 1 green, 2 blue.
uint32_t mosaic_layout(TiffFile &file, const Directory &directory) {
    const std::vector<uint32_t> repeat = file.numbers(directory, tag_cfa_repeat, 2),
                                pattern = file.numbers(directory, tag_cfa_pattern, 4);
    const struct {
        uint32_t layout;
        std::vector<uint32_t> pattern;
    } known[] = {{LENSPROF_LAYOUT_RGGB, {0, 1, 1, 2}},
                 {LENSPROF_LAYOUT_GRBG, {1, 0, 2, 1}},
                 {LENSPROF_LAYOUT_GBRG, {1, 2, 0, 1}},
                 {LENSPROF_LAYOUT_BGGR, {2, 1, 1, 0}}};
    for (const auto &one : known)
        if (repeat == std::vector<uint32_t>{2, 2} && pattern == one.pattern) return one.layout;
    return UINT32_MAX;
}

// The directory with the tag in its place, and the list in front of it, to stand at `offset`. *place receives where the
// directory is.
std::vector<uint8_t> appendix(const TiffFile &file, Directory directory, uint64_t offset, uint16_t tag,
                              const std::vector<uint8_t> &list, uint64_t *place) {
    std::vector<uint8_t> bytes(offset % 2), value;
    if (list.size() > 4) {
        file.put_u32(value, static_cast<uint32_t>(offset + bytes.size()));
        bytes.insert(bytes.end(), list.begin(), list.end());
    } else {
        value = list;
    }
    value.resize(4);
    Entry entry{tag, type_undefined, static_cast<uint32_t>(list.size()), {}};
    std::copy(value.begin(), value.end(), entry.value);
    std::vector<Entry> &all = directory.entries;
    all.erase(std::remove_if(all.begin(), all.end(), [&](const Entry &e) { return e.tag == tag; }), all.end());
    all.insert(std::find_if(all.begin(), all.end(), [&](const Entry &e) { return e.tag > tag; }), entry);
    bytes.resize(bytes.size() + (offset + bytes.size()) % 2);
    *place = offset + bytes.size();
    file.put_u16(bytes, static_cast<uint32_t>(all.size()));
    for (const Entry &one : all) {
        file.put_u16(bytes, one.tag);
        file.put_u16(bytes, one.type);
        file.put_u32(bytes, one.count);
        bytes.insert(bytes.end(), one.value, one.value + 4);
    }
    file.put_u32(bytes, directory.next);
    return bytes;
}

}  // namespace

OpcodeLists read_opcode_lists(const std::string &path) {
    TiffFile file(path);
    OpcodeLists lists;
    const Directory directory = file.find_raw(&lists.raw);
    lists.width = file.number(directory, tag_width, 0);
    lists.height = file.number(directory, tag_height, 0);
    const std::vector<uint32_t> area = file.numbers(directory, tag_active_area, 4);  // top, left, bottom, right
    if (area.size() == 4 && area[0] < area[2] && area[1] < area[3] && area[2] <= lists.height
        && area[3] <= lists.width) {
        lists.width = area[3] - area[1];
        lists.height = area[2] - area[0];
    }
    const bool mosaic = file.number(directory, tag_photometric, 0) == photometric_cfa;
    const uint32_t samples = file.number(directory, tag_samples, 1);
    lists.layout = mosaic         ? mosaic_layout(file, directory)
                   : samples >= 3 ? static_cast<uint32_t>(LENSPROF_LAYOUT_RGB)
                                  : static_cast<uint32_t>(LENSPROF_LAYOUT_GREY);
    lists.list2 = file.bytes_of(directory, tag_opcode_list2);
    lists.list3 = file.bytes_of(directory, tag_opcode_list3);
    return lists;
}

void write_opcode_list(const std::string &path_in, const std::string &path_out, uint16_t tag,
                       const std::vector<uint8_t> &list) {
    TiffFile file(path_in);
    bool raw = false;
    const Directory directory = file.find_raw(&raw);
    const auto too_large = [&](uint64_t size) {
        if (size > UINT32_MAX)
            throw Failure(ExitCode::failed,
                          path_out + ": would have over 4 GiB, which a TIFF cannot; write a smaller map");
    };
    too_large(file.size() + list.size() + 2);
    if (directory.entries.size() >= UINT16_MAX)
        throw Failure(ExitCode::unreadable, path_in + ": has a directory without room; give another file");
    uint64_t place = 0;
    const std::vector<uint8_t> bytes = appendix(file, directory, file.size(), tag, list, &place);
    too_large(file.size() + bytes.size());
    OutputFile output(path_out);
    errno = 0;
    std::fstream target(output.temporary(), std::ios::binary | std::ios::in | std::ios::out);
    file.copy_to(target);
    target.write(reinterpret_cast<const char *>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    std::vector<uint8_t> pointer;
    file.put_u32(pointer, static_cast<uint32_t>(place));
    target.seekp(static_cast<std::streamoff>(directory.pointer));
    target.write(reinterpret_cast<const char *>(pointer.data()), 4);
    target.close();
    if (!target)
        throw Failure(ExitCode::failed, path_out + ": cannot write: " + system_text(errno ? errno : EIO)
                                            + "; make room or check the folder");
    output.commit();
}

}  // namespace lensprof
