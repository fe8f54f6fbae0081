// The excerpt of a TIFF (revision 6.0, section 2): every strip becomes two bytes.
#include <algorithm>

#include "photo/pictures/picture_excerpt.hpp"
#include "photo/pictures/tiff_directory.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr uint16_t strip_offsets = 273, strip_byte_counts = 279;

// Maximum bytes of directory and values.
constexpr uint64_t directory_max_bytes = uint64_t(64) << 20;

// A strip in the excerpt: even, as Exiv2 aligns strips to words.
constexpr uint32_t short_strip = 2;

// Bytes of a TIFF, changed in place. `origin`: position of the first one in the file.
struct TiffBytes {
    std::vector<uint8_t> &bytes;
    TiffByteOrder order;
    uint64_t origin;

    void put(uint64_t place, size_t size, uint32_t value) {
        order.put(&bytes[static_cast<size_t>(place - origin)], size, value);
    }
    // A value of an entry, whose first value is at `place`.
    void put_value(const TiffEntry &entry, uint64_t place, uint32_t i, uint32_t value) {
        const size_t size = tiff_type_bytes(entry.type);
        put(place + i * size, size, value);
    }
    // Adjusts the offsets of values outside the directory after `from` bytes were replaced by `to`.
    void move_values(const TiffDirectory &directory, uint32_t from, uint32_t to) {
        for (const TiffEntry &entry : directory.entries)
            if (!entry.inside()) put(entry.field, 4, order.get(entry.value, 4) - from + to);
    }
};

// One number of each strip: an entry and its values.
struct StripNumbers {
    TiffEntry entry{};
    uint64_t place = 0;
    std::vector<uint32_t> values;
};

// A TIFF with one directory and strips.
struct StripTiff {
    TiffDirectory directory{};
    StripNumbers starts, counts;

    void put_strip(TiffBytes &bytes, uint32_t i, uint32_t start, uint32_t count) const {
        bytes.put_value(starts.entry, starts.place, i, start);
        bytes.put_value(counts.entry, counts.place, i, count);
    }
};

// False if the tag is missing or has another type.
bool find_numbers(TiffReader &reader, const TiffDirectory &directory, uint16_t tag,
                  std::initializer_list<uint16_t> types, StripNumbers &found) {
    const TiffEntry *entry = directory.find(tag);
    if (!entry || std::find(types.begin(), types.end(), entry->type) == types.end()) return false;
    found = {*entry, reader.place(*entry), reader.numbers(directory, tag)};
    return true;
}

// False if it has another layout.
bool is_strip_tiff(TiffReader &reader, StripTiff &tiff) {
    tiff.directory = reader.first();
    if (tiff.directory.next != 0) return false;
    for (const TiffEntry &entry : tiff.directory.entries)
        if (entry.bytes() == 0 || entry.type == tiff_ifd) return false;
    reader.check_values(tiff.directory);
    return find_numbers(reader, tiff.directory, strip_offsets, {tiff_long}, tiff.starts)
           && find_numbers(reader, tiff.directory, strip_byte_counts, {tiff_short, tiff_long}, tiff.counts)
           && tiff.starts.values.size() == tiff.counts.values.size();
}

bool has_other_directories(const TiffDirectory &directory) {
    static const uint16_t tags[] = {330, 34665, 34853, 40965};
    return std::any_of(std::begin(tags), std::end(tags), [&](uint16_t tag) { return directory.find(tag) != nullptr; });
}

class TiffExcerpt final : public PictureExcerpt {
public:
    explicit TiffExcerpt(const std::string &path) : PictureExcerpt(path) {}

    bool make();
    bool replace(const uint8_t *edited, size_t size) const override;

private:
    struct Strip {
        uint32_t start, bytes;
    };

    bool is_of_strips_first(const TiffReader &reader, const StripTiff &tiff) const;
    void replace_directory(std::vector<uint8_t> edited, const StripTiff &tiff) const;
    bool replace_all(std::vector<uint8_t> edited, const StripTiff &tiff) const;
    uint32_t short_end() const { return tiff_header_bytes + short_strip * static_cast<uint32_t>(strips_.size()); }

    TiffByteOrder order_;
    uint32_t directory_ = 0;  // of the file
    std::vector<Strip> strips_;
};

// As libtiff writes them: all strips before the directory, all values after it.
bool TiffExcerpt::is_of_strips_first(const TiffReader &reader, const StripTiff &tiff) const {
    for (size_t i = 0; i < tiff.starts.values.size(); ++i)
        if (tiff.starts.values[i] < tiff_header_bytes
            || uint64_t(tiff.starts.values[i]) + tiff.counts.values[i] > directory_)
            return false;
    for (const TiffEntry &entry : tiff.directory.entries)
        if (reader.place(entry) < directory_) return false;
    return !has_other_directories(tiff.directory);
}

bool TiffExcerpt::make() {
    const File file = open_for_reading(path_);
    const uint64_t size = file_bytes(file.get());
    std::vector<uint8_t> directory, piece;
    TiffReader reader(size, [&](uint64_t offset, uint8_t *bytes, size_t count) {
        if (!read_at(file.get(), offset, count, piece)) throw UnusableTiff(TiffDefect::cut_off);
        std::copy(piece.begin(), piece.end(), bytes);
    });
    order_ = reader.order();
    StripTiff tiff;
    if (!is_strip_tiff(reader, tiff)) return false;
    directory_ = static_cast<uint32_t>(tiff.directory.offset);
    if (directory_ < tiff_header_bytes || directory_ % 2 != 0 || size - directory_ > directory_max_bytes
        || !is_of_strips_first(reader, tiff)
        || !read_at(file.get(), directory_, static_cast<size_t>(size - directory_), directory)
        || !read_at(file.get(), 0, tiff_header_bytes, bytes_))
        return false;
    for (size_t i = 0; i < tiff.starts.values.size(); ++i)
        strips_.push_back({tiff.starts.values[i], tiff.counts.values[i]});
    TiffBytes moved{directory, order_, directory_};
    for (uint32_t i = 0; i < strips_.size(); ++i)
        tiff.put_strip(moved, i, tiff_header_bytes + short_strip * i, short_strip);
    moved.move_values(tiff.directory, directory_, short_end());
    TiffBytes{bytes_, order_, 0}.put(4, 4, short_end());
    bytes_.resize(short_end());
    bytes_.insert(bytes_.end(), directory.begin(), directory.end());
    return true;
}

bool TiffExcerpt::replace(const uint8_t *edited, size_t size) const {
    if (size < tiff_header_bytes || !std::equal(edited, edited + 4, bytes_.begin())) return false;
    StripTiff tiff;
    try {
        TiffReader reader(
            size, [&](uint64_t offset, uint8_t *bytes, size_t count) { std::copy_n(edited + offset, count, bytes); });
        if (!is_strip_tiff(reader, tiff) || tiff.starts.values.size() != strips_.size()) return false;
    } catch (const UnusableTiff &) {
        return false;
    }
    const uint32_t pixels = tiff.starts.values[0];
    for (uint32_t i = 0; i < strips_.size(); ++i)
        if (tiff.starts.values[i] != pixels + short_strip * i || tiff.counts.values[i] != short_strip) return false;
    std::vector<uint8_t> copy(edited, edited + size);
    if (size != bytes_.size() || pixels != tiff_header_bytes)
        return uint64_t(pixels) + short_strip * strips_.size() == size && replace_all(std::move(copy), tiff);
    if (tiff.directory.offset != short_end()) return false;
    replace_directory(std::move(copy), tiff);
    return true;
}

// Exiv2 changed values in place.
void TiffExcerpt::replace_directory(std::vector<uint8_t> edited, const StripTiff &tiff) const {
    TiffBytes moved{edited, order_, 0};
    for (uint32_t i = 0; i < strips_.size(); ++i) tiff.put_strip(moved, i, strips_[i].start, strips_[i].bytes);
    moved.move_values(tiff.directory, short_end(), directory_);
    const File file = open_for_reading(path_);
    Replacement to(path_, file.get());
    to.copy(0, directory_);
    to.write(edited.data() + short_end(), edited.size() - short_end());
    to.commit();
}

// Exiv2 rewrote the file: directories first, then the strips, each at an even position.
bool TiffExcerpt::replace_all(std::vector<uint8_t> edited, const StripTiff &tiff) const {
    const uint32_t pixels = tiff.starts.values[0];
    TiffBytes moved{edited, order_, 0};
    uint64_t place = pixels;
    for (uint32_t i = 0; i < strips_.size(); ++i) {
        tiff.put_strip(moved, i, static_cast<uint32_t>(place), strips_[i].bytes);
        place += strips_[i].bytes + strips_[i].bytes % 2;
    }
    if (place > UINT32_MAX) return false;
    const File file = open_for_reading(path_);
    Replacement to(path_, file.get());
    to.write(edited.data(), pixels);
    for (const Strip &strip : strips_) {
        to.copy(strip.start, strip.bytes);
        to.write("", strip.bytes % 2);
    }
    to.commit();
    return true;
}

}  // namespace

std::unique_ptr<PictureExcerpt> excerpt_of_tiff(const std::string &path) {
    auto excerpt = std::make_unique<TiffExcerpt>(path);
    try {
        return excerpt->make() ? std::move(excerpt) : nullptr;
    } catch (const UnusableTiff &) {
        return nullptr;
    }
}

}  // namespace codec

}  // namespace lensprof
