// The directories of a classic TIFF (revision 6.0, section 2), from a file or memory. Every position and count declared
// by a file is checked here before use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <vector>

namespace lensprof {

// Defects that make a TIFF unusable.
enum class TiffDefect {
    not_tiff,
    big_tiff,
    no_directory,
    cut_off,         // it ends before a directory or value
    pixels_cut_off,  // it ends before the end of a strip or tile
    circle,          // circular directories, or more than 256
};

// Thrown by TiffReader.
struct UnusableTiff : std::exception {
    explicit UnusableTiff(TiffDefect reason) : defect(reason) {}
    const char *what() const noexcept override { return "the TIFF file is unusable"; }

    TiffDefect defect;
};

constexpr uint16_t tiff_byte = 1, tiff_short = 3, tiff_long = 4, tiff_undefined = 7, tiff_ifd = 13;
constexpr uint32_t photometric_cfa = 32803, photometric_linear_raw = 34892;
constexpr uint32_t tiff_header_bytes = 8;

// Bytes of a value of this type; 0 for a type that TIFF does not define.
uint32_t tiff_type_bytes(uint16_t type);

struct TiffByteOrder {
    bool big = false;
    uint32_t get(const uint8_t *bytes, size_t size) const;  // of at most 4 bytes
    void put(uint8_t *bytes, size_t size, uint32_t value) const;
};

struct TiffEntry {
    uint16_t tag, type;
    uint32_t count;
    uint8_t value[4];  // as in the file: the values, or the offset of values of more than 4 bytes
    uint64_t field;    // position of `value` in the file

    uint64_t bytes() const { return uint64_t(count) * tiff_type_bytes(type); }
    bool inside() const { return bytes() <= 4; }
};

struct TiffDirectory {
    uint64_t pointer;  // position in the file of the offset that points here
    uint64_t offset;
    std::vector<TiffEntry> entries;
    uint32_t next;  // offset of the next directory of the chain; 0 at the end

    const TiffEntry *find(uint16_t tag) const;  // NULL if not found
    uint64_t next_pointer() const { return offset + 2 + 12 * entries.size(); }
};

class TiffReader {
public:
    // Reads `count` bytes from `offset` on, all below the size given to the reader. Its exceptions propagate through
    // the reader.
    using Read = std::function<void(uint64_t offset, uint8_t *bytes, size_t count)>;

    // Reads the header of a file of `size` bytes.
    TiffReader(uint64_t size, Read read);

    const TiffByteOrder &order() const { return order_; }

    // The directory that the offset at `pointer` points to.
    TiffDirectory directory(uint64_t pointer);
    TiffDirectory directory_at(uint64_t offset);  // without a pointer
    TiffDirectory first() { return directory(4); }

    // Pointers to the directories of the SubIFDs tag; empty without the tag. A directory may have 65535 entries, so
    // callers read them one at a time.
    std::vector<uint64_t> children(const TiffDirectory &directory) const;

    // Checks that all values of a directory, and the strips and tiles it declares, are within the file.
    void check_values(const TiffDirectory &directory) const;
    void check_blocks(const TiffDirectory &directory);

    // Position in the file of an entry's values, which must all be within the file.
    uint64_t place(const TiffEntry &entry) const;

    // The first `max_count` numbers of a tag of bytes, shorts or longs; empty if it is missing or of another type.
    std::vector<uint32_t> numbers(const TiffDirectory &directory, uint16_t tag, uint32_t max_count = UINT32_MAX);
    uint32_t number(const TiffDirectory &directory, uint16_t tag, uint32_t fallback);

    // The values as they are in the file.
    std::vector<uint8_t> bytes(const TiffEntry &entry) { return first_bytes(entry, entry.bytes()); }

private:
    std::vector<uint8_t> read(uint64_t offset, uint64_t count);
    std::vector<uint8_t> first_bytes(const TiffEntry &entry, uint64_t count);
    void check_blocks(const TiffDirectory &directory, uint16_t offsets_tag, uint16_t bytes_tag);
    bool has(uint64_t offset, uint64_t count) const { return offset <= size_ && count <= size_ - offset; }

    uint64_t size_;
    Read read_;
    TiffByteOrder order_;
    uint32_t directories_ = 0;  // read so far
};

}  // namespace lensprof
