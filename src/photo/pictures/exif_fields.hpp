// The fields of EXIF (CIPA DC-008, chapter 4): those of the main directory of a TIFF structure (IFD0), and of the Exif,
// GPS and interoperability directories. Directories of thumbnails are not read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "photo/pictures/tiff_directory.hpp"

namespace lensprof {

enum class ExifGroup : uint8_t {
    image,
    photo,
    gps,
    interoperability
};
constexpr size_t exif_groups = 4;

struct ExifTag {
    ExifGroup group;
    uint16_t tag;
};

struct ExifField {
    uint16_t tag = 0, type = 0;
    uint32_t count = 0;
    std::vector<uint8_t> bytes;  // the values, in the byte order of the structure; empty: too large to be read
    uint64_t place = 0;          // where the values stay if the file is changed; 0 = they are written
};

struct Exif {
    std::array<std::vector<ExifField>, exif_groups> fields;
    TiffByteOrder order;
    uint32_t note_place =
        0;  // offset of the maker note in its structure, from which its own offsets count; 0 = unknown
    uint64_t start = UINT64_MAX;  // lowest position of a directory or of values in the file

    std::vector<ExifField> &group(ExifGroup which) { return fields[static_cast<size_t>(which)]; }
    const std::vector<ExifField> &group(ExifGroup which) const { return fields[static_cast<size_t>(which)]; }

    const ExifField *find(ExifTag tag) const;  // the first one; NULL if missing
    void erase(ExifTag tag);
    void set(ExifTag tag, uint16_t type, uint32_t count, std::vector<uint8_t> bytes);  // replaces
    void set_number(ExifTag tag, uint16_t type, uint32_t value);                       // a short or long
    void set_text(ExifTag tag, const std::string &text);
    bool is_empty() const;
};

constexpr uint16_t exif_ascii = 2, exif_rational = 5;
constexpr uint16_t exif_pointer = 0x8769, gps_pointer = 0x8825, interoperability_pointer = 0xa005,
                   maker_note_tag = 0x927c;

// Values outside the structure and directories that are cut off are skipped; of an unusable structure nothing is left.
Exif read_exif(TiffReader &reader, const TiffDirectory &first);
Exif read_exif(const std::vector<uint8_t> &block);  // without places, and empty if it is not a TIFF structure

// The values of a field in another byte order.
ExifField in_order(ExifField field, TiffByteOrder from, TiffByteOrder to);
void set_order(Exif &exif, TiffByteOrder order);

}  // namespace lensprof
