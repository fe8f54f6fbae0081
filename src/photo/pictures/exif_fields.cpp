#include "photo/pictures/exif_fields.hpp"

#include <algorithm>

namespace lensprof {

namespace {

constexpr uint64_t max_value_bytes = uint64_t(64) << 20;  // of all fields together

constexpr struct {
    ExifGroup parent, group;
    uint16_t pointer;
} sub_directories[] = {{ExifGroup::image, ExifGroup::photo, exif_pointer},
                       {ExifGroup::image, ExifGroup::gps, gps_pointer},
                       {ExifGroup::photo, ExifGroup::interoperability, interoperability_pointer}};

bool is_pointer(uint16_t tag) { return tag == exif_pointer || tag == gps_pointer || tag == interoperability_pointer; }

class FieldReader {
public:
    explicit FieldReader(TiffReader &reader) : reader_(reader) { exif.order = reader.order(); }

    void read(const TiffDirectory &directory, ExifGroup group) {
        exif.start = std::min(exif.start, directory.offset);
        for (const TiffEntry &entry : directory.entries) {
            if (entry.bytes() == 0 || is_pointer(entry.tag)) continue;
            try {
                read(entry, group);
            } catch (const UnusableTiff &) {  // its value is outside
            }
        }
        for (const auto &sub : sub_directories)
            if (sub.parent == group) read_sub_directory(directory, sub.pointer, sub.group);
    }

    Exif exif;

private:
    void read(const TiffEntry &entry, ExifGroup group) {
        const uint64_t place = reader_.place(entry);
        ExifField field{entry.tag, entry.type, entry.count, {}, entry.inside() ? 0 : place};
        if (entry.bytes() <= rest_) {
            field.bytes = reader_.bytes(entry);
            rest_ -= entry.bytes();
        }
        if (!entry.inside()) exif.start = std::min(exif.start, place);
        if (group == ExifGroup::photo && entry.tag == maker_note_tag) exif.note_place = static_cast<uint32_t>(place);
        exif.group(group).push_back(std::move(field));
    }

    void read_sub_directory(const TiffDirectory &parent, uint16_t pointer, ExifGroup group) {
        try {
            const uint32_t offset = reader_.number(parent, pointer, 0);
            if (offset >= tiff_header_bytes) read(reader_.directory_at(offset), group);
        } catch (const UnusableTiff &) {  // cut off
        }
    }

    TiffReader &reader_;
    uint64_t rest_ = max_value_bytes;
};

}  // namespace

const ExifField *Exif::find(ExifTag tag) const {
    const auto &all = group(tag.group);
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const ExifField &field) { return field.tag == tag.tag; });
    return found == all.end() ? nullptr : &*found;
}

void Exif::erase(ExifTag tag) {
    auto &all = group(tag.group);
    all.erase(std::remove_if(all.begin(), all.end(), [&](const ExifField &field) { return field.tag == tag.tag; }),
              all.end());
}

void Exif::set(ExifTag tag, uint16_t type, uint32_t count, std::vector<uint8_t> bytes) {
    erase(tag);
    if (!bytes.empty()) group(tag.group).push_back({tag.tag, type, count, std::move(bytes), 0});
}

void Exif::set_number(ExifTag tag, uint16_t type, uint32_t value) {
    std::vector<uint8_t> bytes(tiff_type_bytes(type));
    order.put(bytes.data(), bytes.size(), value);
    set(tag, type, 1, std::move(bytes));
}

void Exif::set_text(ExifTag tag, const std::string &text) {
    std::vector<uint8_t> bytes(text.begin(), text.end());
    bytes.push_back(0);
    const uint32_t count = static_cast<uint32_t>(bytes.size());
    set(tag, exif_ascii, count, std::move(bytes));
}

bool Exif::is_empty() const {
    return std::all_of(fields.begin(), fields.end(), [](const auto &all) { return all.empty(); });
}

Exif read_exif(TiffReader &reader, const TiffDirectory &first) {
    FieldReader fields(reader);
    fields.read(first, ExifGroup::image);
    return std::move(fields.exif);
}

Exif read_exif(const std::vector<uint8_t> &block) {
    Exif exif;
    try {
        TiffReader reader(block.size(), [&](uint64_t offset, uint8_t *bytes, size_t count) {
            std::copy_n(block.begin() + static_cast<std::ptrdiff_t>(offset), count, bytes);
        });
        exif = read_exif(reader, reader.first());
    } catch (const UnusableTiff &) {
    }
    for (auto &all : exif.fields)
        for (ExifField &field : all) field.place = 0;
    return exif;
}

ExifField in_order(ExifField field, TiffByteOrder from, TiffByteOrder to) {
    constexpr uint16_t rational = 5, signed_rational = 10;  // two numbers of four bytes
    size_t size = tiff_type_bytes(field.type);
    if (field.type == rational || field.type == signed_rational) size = 4;
    if (from.big == to.big || size < 2) return field;
    for (size_t i = 0; i + size <= field.bytes.size(); i += size)
        std::reverse(field.bytes.begin() + static_cast<std::ptrdiff_t>(i),
                     field.bytes.begin() + static_cast<std::ptrdiff_t>(i + size));
    return field;
}

void set_order(Exif &exif, TiffByteOrder order) {
    for (auto &all : exif.fields)
        for (ExifField &field : all) field = in_order(std::move(field), exif.order, order);
    exif.order = order;
}

}  // namespace lensprof
