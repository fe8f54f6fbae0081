#include "photo/pictures/maker_note.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <string>
#include <vector>

#include "photo/pictures/exif_value.hpp"
#include "photo/pictures/tiff_directory.hpp"

namespace lensprof {
namespace {

constexpr uint16_t kMake = 0x010f, kModel = 0x0110, kExif = 0x8769, kMakerNote = 0x927c;
constexpr size_t kEntryBytes = 12, kMaxNoteBytes = 1 << 20;

// Whether the bytes begin with a TIFF directory, all of whose entries have a type.
bool is_directory(const std::vector<uint8_t> &bytes, size_t start, TiffByteOrder order) {
    constexpr uint32_t max_entries = 256;
    if (bytes.size() < start + 2) return false;
    const uint32_t entries = order.get(&bytes[start], 2);
    if (entries == 0 || entries > max_entries || bytes.size() < start + 2 + kEntryBytes * entries) return false;
    for (uint32_t i = 0; i < entries; i++)
        if (!tiff_type_bytes(static_cast<uint16_t>(order.get(&bytes[start + 4 + kEntryBytes * i], 2)))) return false;
    return true;
}

// Whether a note without a byte order of its own makes sense only in the other order.
bool is_in_other_order(const std::vector<uint8_t> &note, TiffByteOrder order) {
    static const struct {
        const char *text;
        size_t bytes;
    } headers[] = {{"SONY DSC ", 12}, {"SONY CAM ", 12}, {"SONY MOBILE", 12}, {"Panasonic", 12}, {"", 0}};
    const auto header = std::find_if(std::begin(headers), std::end(headers), [&](const auto &entry) {
        const size_t length = std::strlen(entry.text);
        return note.size() >= length && std::memcmp(note.data(), entry.text, length) == 0;
    });
    return !is_directory(note, header->bytes, order) && is_directory(note, header->bytes, TiffByteOrder{!order.big});
}

// A TIFF with maker, model and the maker note at its place, from which the note's offsets count.
class NoteBlock {
public:
    NoteBlock(const std::vector<uint8_t> &note, uint32_t offset, TiffByteOrder order)
        : order_(order), bytes_((offset + note.size() + 1) & ~size_t(1)) {
        std::memcpy(bytes_.data(), order.big ? "MM" : "II", 2);
        order_.put(&bytes_[2], 2, 42);
        std::copy(note.begin(), note.end(), bytes_.begin() + offset);
    }

    uint32_t end() const { return static_cast<uint32_t>(bytes_.size()); }

    uint32_t add_text(std::string text) {
        const uint32_t start = end();
        text.resize((text.size() + 2) & ~size_t(1));
        bytes_.insert(bytes_.end(), text.begin(), text.end());
        return start;
    }

    void put(size_t count, uint32_t value) {
        bytes_.resize(bytes_.size() + count);
        order_.put(&bytes_[bytes_.size() - count], count, value);
    }

    void add_entry(uint16_t tag, uint16_t type, uint32_t count, uint32_t value) {
        put(2, tag), put(2, type), put(4, count), put(4, value);
    }

    void set_first_directory() { order_.put(&bytes_[4], 4, end()); }

    const std::vector<uint8_t> &bytes() const { return bytes_; }

private:
    TiffByteOrder order_;
    std::vector<uint8_t> bytes_;
};

std::vector<uint8_t> block_of(const std::vector<uint8_t> &note, uint32_t offset, TiffByteOrder order,
                              const std::string &maker, const std::string &model) {
    constexpr uint16_t tiff_ascii = 2;
    NoteBlock block(note, offset, order);
    const uint32_t maker_at = block.add_text(maker), model_at = block.add_text(model), exif_at = block.end();
    block.put(2, 1);
    block.add_entry(kMakerNote, tiff_undefined, static_cast<uint32_t>(note.size()), offset);
    block.put(4, 0);
    block.set_first_directory();
    block.put(2, 3);
    block.add_entry(kMake, tiff_ascii, static_cast<uint32_t>(maker.size() + 1), maker_at);
    block.add_entry(kModel, tiff_ascii, static_cast<uint32_t>(model.size() + 1), model_at);
    block.add_entry(kExif, tiff_long, 1, exif_at);
    block.put(4, 0);
    return block.bytes();
}

}  // namespace

void repair_maker_note(MakerExif &maker_exif) {
    Exiv2::ExifData &exif = maker_exif.data;
    const auto datum = exif.findKey(Exiv2::ExifKey("Exif.Photo.MakerNote"));
    const auto text = [&](const char *key) {
        const auto found = exif.findKey(Exiv2::ExifKey(key));
        return found == exif.end() ? std::string() : clean_text(found->toString());
    };
    const auto place = exif.findKey(Exiv2::ExifKey("Exif.MakerNote.Offset"));
    const long offset = place == exif.end() || place->count() == 0 ? 0 : place->toLong();
    const std::string order_name = text("Exif.MakerNote.ByteOrder"), maker = text("Exif.Image.Make");
    if (datum == exif.end() || datum->size() <= 0 || offset < 8 || offset >= long(kMaxNoteBytes) || maker.size() < 4)
        return;
    std::vector<uint8_t> note(static_cast<size_t>(datum->size()));
    datum->copy(note.data(), Exiv2::invalidByteOrder);
    const TiffByteOrder stated{order_name == "MM"}, other{!stated.big};
    if (note.size() > kMaxNoteBytes || !is_in_other_order(note, stated)) return;
    const std::vector<uint8_t> block =
        block_of(note, static_cast<uint32_t>(offset), other, maker, text("Exif.Image.Model") + "    ");
    Exiv2::ExifData repaired;
    if (Exiv2::ExifParser::decode(repaired, block.data(), static_cast<uint32_t>(block.size()))
        == Exiv2::invalidByteOrder)
        return;
    const auto is_of_maker = [](const Exiv2::Exifdatum &entry) {
        return Exiv2::ExifTags::isMakerGroup(entry.groupName());
    };
    for (auto entry = exif.begin(); entry != exif.end();) entry = is_of_maker(*entry) ? exif.erase(entry) : ++entry;
    for (const Exiv2::Exifdatum &entry : repaired)
        if (is_of_maker(entry)) exif.add(entry);
    maker_exif.order = other.big ? Exiv2::bigEndian : Exiv2::littleEndian;
}

}  // namespace lensprof
