#include "photo/pictures/exif_layout.hpp"

#include <algorithm>
#include <cstring>

#include "photo/pictures/note_place.hpp"

namespace lensprof {

namespace {

constexpr uint32_t max_kept_place = 8192;  // the bytes before a maker note count towards the limit of a JPEG

class ExifWriter {
public:
    ExifWriter(const Exif &exif, uint64_t origin)
        : exif_(exif), origin_(origin), bytes_(origin ? 0 : tiff_header_bytes) {
        const ExifField *note = exif.find({ExifGroup::photo, maker_note_tag});
        keeps_note_ = !origin && note && note->bytes.size() > 4 && exif.note_place >= tiff_header_bytes
                      && exif.note_place <= max_kept_place;
        if (!keeps_note_) return;
        before_ = tiff_header_bytes, note_start_ = exif.note_place;
        bytes_.resize((note_start_ + note->bytes.size() + 1) & ~size_t(1));
    }

    std::vector<uint8_t> take(uint32_t next) {
        sort_fields();
        for (size_t i = 0; i < exif_groups; ++i)
            if (has(i)) tables_[i] = reserve(2 + 12 * sorted_[i].size() + 4);
        set_pointer(ExifGroup::image, exif_pointer, ExifGroup::photo);
        set_pointer(ExifGroup::image, gps_pointer, ExifGroup::gps);
        set_pointer(ExifGroup::photo, interoperability_pointer, ExifGroup::interoperability);
        for (size_t i = 0; i < exif_groups; ++i)
            if (has(i)) write_table(i, i == 0 ? next : 0);
        if (origin_ > 0) return std::move(bytes_);
        std::memcpy(bytes_.data(), exif_.order.big ? "MM" : "II", 2);
        put(2, 2, 42), put(4, 4, static_cast<uint32_t>(tables_[0]));
        return std::move(bytes_);
    }

private:
    bool has(size_t group) const { return group == 0 || !sorted_[group].empty(); }

    // In ascending order, each tag once, with room for pointers.
    void sort_fields() {
        for (size_t i = exif_groups; i-- > 0;) {
            std::vector<ExifField> &fields = sorted_[i] = exif_.fields[i];
            const auto is_lost = [](const ExifField &field) { return field.bytes.empty() && field.place == 0; };
            fields.erase(std::remove_if(fields.begin(), fields.end(), is_lost), fields.end());
            if (i == 0 && has_any(ExifGroup::photo)) add_pointer(fields, exif_pointer);
            if (i == 0 && has_any(ExifGroup::gps)) add_pointer(fields, gps_pointer);
            if (i == 1 && has_any(ExifGroup::interoperability)) add_pointer(fields, interoperability_pointer);
            std::stable_sort(fields.begin(), fields.end(),
                             [](const ExifField &a, const ExifField &b) { return a.tag < b.tag; });
            fields.erase(std::unique(fields.begin(), fields.end(),
                                     [](const ExifField &a, const ExifField &b) { return a.tag == b.tag; }),
                         fields.end());
        }
    }

    bool has_any(ExifGroup group) const { return !sorted_[static_cast<size_t>(group)].empty(); }

    static void add_pointer(std::vector<ExifField> &fields, uint16_t tag) {
        fields.push_back({tag, tiff_long, 1, std::vector<uint8_t>(4), 0});
    }

    void set_pointer(ExifGroup parent, uint16_t tag, ExifGroup group) {
        for (ExifField &field : sorted_[static_cast<size_t>(parent)])
            if (field.tag == tag)
                exif_.order.put(field.bytes.data(), 4, static_cast<uint32_t>(tables_[static_cast<size_t>(group)]));
    }

    // Position in the file of new bytes at an even offset, before the note if they fit there.
    uint64_t reserve(uint64_t count) {
        count += count % 2;
        if (before_ + count <= note_start_) {
            before_ += count;
            return before_ - count;
        }
        bytes_.resize(bytes_.size() + static_cast<size_t>(count));
        return origin_ + bytes_.size() - count;
    }

    void put(uint64_t place, size_t size, uint32_t value) {
        exif_.order.put(&bytes_[static_cast<size_t>(place - origin_)], size, value);
    }

    void copy(const std::vector<uint8_t> &values, uint64_t place) {
        std::copy(values.begin(), values.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(place - origin_));
    }

    void write_table(size_t group, uint32_t next) {
        const std::vector<ExifField> &fields = sorted_[group];
        uint64_t place = tables_[group];
        put(place, 2, static_cast<uint32_t>(fields.size()));
        place += 2;
        for (const ExifField &field : fields) {
            put(place, 2, field.tag), put(place + 2, 2, field.type), put(place + 4, 4, field.count);
            if (field.place > 0)
                put(place + 8, 4, static_cast<uint32_t>(field.place));
            else if (field.bytes.size() <= 4)
                copy(field.bytes, place + 8);
            else
                put(place + 8, 4, static_cast<uint32_t>(write_values(field, group)));
            place += 12;
        }
        put(place, 4, next);
    }

    uint64_t write_values(const ExifField &field, size_t group) {
        const bool is_note = group == static_cast<size_t>(ExifGroup::photo) && field.tag == maker_note_tag;
        const uint64_t place = is_note && keeps_note_ ? note_start_ : reserve(field.bytes.size());
        copy(is_note && !keeps_note_ ? moved_note(field.bytes, exif_.note_place, place) : field.bytes, place);
        return place;
    }

    const Exif &exif_;
    uint64_t origin_;
    std::vector<uint8_t> bytes_;  // of the file, from the origin on
    std::array<std::vector<ExifField>, exif_groups> sorted_;
    std::array<uint64_t, exif_groups> tables_{};
    bool keeps_note_ = false;
    uint64_t before_ = 0, note_start_ = 0;  // free bytes before the note
};

}  // namespace

std::vector<uint8_t> exif_block(const Exif &exif) {
    return exif.is_empty() ? std::vector<uint8_t>() : ExifWriter(exif, 0).take(0);
}

std::vector<uint8_t> appended_exif(const Exif &exif, uint64_t start, uint32_t next) {
    return ExifWriter(exif, start).take(next);
}

}  // namespace lensprof
