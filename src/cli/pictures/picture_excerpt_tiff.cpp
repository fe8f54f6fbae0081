// The excerpt of a TIFF (revision 6.0, section 2): every strip becomes two bytes.
#include <algorithm>

#include "cli/pictures/picture_excerpt.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr uint16_t strip_offsets = 273, strip_byte_counts = 279;

// Most bytes of directory and values.
constexpr uint64_t directory_max_bytes = uint64_t(64) << 20;

// A strip in the excerpt: even, as Exiv2 aligns strips to words.
constexpr uint32_t short_strip = 2;

// Where the directory is in a file that libtiff wrote: behind all strips, its values behind it.
constexpr uint32_t header_bytes = 8;

struct Entry {
    uint16_t tag, type;
    uint32_t count;
    size_t field;  // of the value, or of the offset to it
    size_t bytes;  // of the value
    bool inside() const { return bytes <= 4; }
};

// Numbers of a TIFF in memory. `origin`: where its first byte is in the file that offsets are of.
class TiffBytes {
public:
    TiffBytes(std::vector<uint8_t> &bytes, bool little_endian, uint32_t origin)
        : bytes_(bytes), little_(little_endian), origin_(origin) {}

    uint32_t get(size_t at, size_t size) const {
        uint32_t value = 0;
        for (size_t i = 0; i < size; ++i) value |= uint32_t(bytes_[at + (little_ ? i : size - 1 - i)]) << (8 * i);
        return value;
    }

    void put(size_t at, size_t size, uint32_t value) {
        for (size_t i = 0; i < size; ++i)
            bytes_[at + (little_ ? i : size - 1 - i)] = static_cast<uint8_t>(value >> (8 * i));
    }

    // The entries of a directory that is the only one, all of whose values are here; empty when it is another.
    std::vector<Entry> entries(size_t at) const;

    size_t place(const Entry &entry) const {
        return entry.inside() ? entry.field : get(entry.field, 4) - size_t(origin_);
    }
    uint32_t number(const Entry &entry, uint32_t i) const {
        const size_t size = entry.bytes / entry.count;
        return get(place(entry) + i * size, size);
    }
    void set_number(const Entry &entry, uint32_t i, uint32_t value) {
        const size_t size = entry.bytes / entry.count;
        put(place(entry) + i * size, size, value);
    }

private:
    std::vector<uint8_t> &bytes_;
    bool little_;
    uint32_t origin_;
};

std::vector<Entry> TiffBytes::entries(size_t at) const {
    static const size_t type_bytes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8};
    std::vector<Entry> entries;
    if (at + 2 > bytes_.size()) return {};
    const size_t count = get(at, 2), end = at + 2 + 12 * count;
    if (end + 4 > bytes_.size() || get(end, 4) != 0) return {};
    for (size_t field = at + 2; field < end; field += 12) {
        const uint32_t type = get(field + 2, 2), values = get(field + 4, 4);
        if (type == 0 || type > 12 || values == 0 || values > bytes_.size()) return {};
        const Entry entry = {static_cast<uint16_t>(get(field, 2)), static_cast<uint16_t>(type), values, field + 8,
                             values * type_bytes[type]};
        const uint64_t start = entry.inside() ? 0 : get(entry.field, 4);
        if (!entry.inside() && (start < origin_ || start - origin_ + entry.bytes > bytes_.size())) return {};
        entries.push_back(entry);
    }
    return entries;
}

// NULL when there is none.
const Entry *find(const std::vector<Entry> &entries, uint16_t tag) {
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const Entry &entry) { return entry.tag == tag; });
    return found == entries.end() ? nullptr : &*found;
}

bool has_other_directories(const std::vector<Entry> &entries) {
    static const uint16_t tags[] = {330, 34665, 34853, 40965};
    return std::any_of(std::begin(tags), std::end(tags), [&](uint16_t tag) { return find(entries, tag) != nullptr; });
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

    bool find_strips(const TiffBytes &tiff, const std::vector<Entry> &entries);
    bool replace_directory(std::vector<uint8_t> edited) const;
    bool replace_all(std::vector<uint8_t> edited, uint32_t pixels) const;
    uint32_t short_end() const { return header_bytes + short_strip * static_cast<uint32_t>(strips_.size()); }

    bool little_ = true;
    uint32_t directory_ = 0;  // of the file
    std::vector<Strip> strips_;
};

// The strips of the file, all before the directory.
bool TiffExcerpt::find_strips(const TiffBytes &tiff, const std::vector<Entry> &entries) {
    const Entry *starts = find(entries, strip_offsets), *counts = find(entries, strip_byte_counts);
    if (!starts || !counts || starts->type != 4 || (counts->type != 3 && counts->type != 4)
        || starts->count != counts->count || has_other_directories(entries))
        return false;
    for (uint32_t i = 0; i < starts->count; ++i) {
        const Strip strip = {tiff.number(*starts, i), tiff.number(*counts, i)};
        if (strip.start < header_bytes || uint64_t(strip.start) + strip.bytes > directory_) return false;
        strips_.push_back(strip);
    }
    return true;
}

bool TiffExcerpt::make() {
    const File file = open_for_reading(path_);
    const uint64_t size = file_bytes(file.get());
    std::vector<uint8_t> header, directory;
    if (!read_at(file.get(), 0, header_bytes, header)) return false;
    little_ = header[0] == 'I';
    TiffBytes start(header, little_, 0);
    directory_ = start.get(4, 4);
    if (start.get(2, 2) != 42 || directory_ < header_bytes || directory_ % 2 != 0 || directory_ >= size
        || size - directory_ > directory_max_bytes
        || !read_at(file.get(), directory_, static_cast<size_t>(size - directory_), directory))
        return false;
    TiffBytes tiff(directory, little_, directory_);
    const std::vector<Entry> entries = tiff.entries(0);
    if (!find_strips(tiff, entries)) return false;
    for (uint32_t i = 0; i < strips_.size(); ++i) {
        tiff.set_number(*find(entries, strip_offsets), i, header_bytes + short_strip * i);
        tiff.set_number(*find(entries, strip_byte_counts), i, short_strip);
    }
    for (const Entry &entry : entries) {
        if (!entry.inside()) tiff.put(entry.field, 4, tiff.get(entry.field, 4) - directory_ + short_end());
    }
    start.put(4, 4, short_end());
    bytes_ = header;
    bytes_.resize(short_end());
    bytes_.insert(bytes_.end(), directory.begin(), directory.end());
    return true;
}

bool TiffExcerpt::replace(const uint8_t *edited, size_t size) const {
    std::vector<uint8_t> copy(edited, edited + size);
    if (size < header_bytes || !std::equal(edited, edited + 4, bytes_.begin())) return false;
    const TiffBytes tiff(copy, little_, 0);
    const std::vector<Entry> entries = tiff.entries(tiff.get(4, 4));
    const Entry *starts = find(entries, strip_offsets), *counts = find(entries, strip_byte_counts);
    if (!starts || !counts || starts->type != 4 || starts->count != strips_.size() || counts->count != strips_.size())
        return false;
    const uint32_t pixels = tiff.number(*starts, 0);
    for (uint32_t i = 0; i < strips_.size(); ++i) {
        if (tiff.number(*starts, i) != pixels + short_strip * i || tiff.number(*counts, i) != short_strip) return false;
    }
    if (size == bytes_.size() && pixels == header_bytes)
        return tiff.get(4, 4) == short_end() && replace_directory(std::move(copy));
    return uint64_t(pixels) + short_strip * strips_.size() == size && replace_all(std::move(copy), pixels);
}

// Exiv2 changed values where they were.
bool TiffExcerpt::replace_directory(std::vector<uint8_t> edited) const {
    TiffBytes tiff(edited, little_, 0);
    const std::vector<Entry> entries = tiff.entries(short_end());
    for (uint32_t i = 0; i < strips_.size(); ++i) {
        tiff.set_number(*find(entries, strip_offsets), i, strips_[i].start);
        tiff.set_number(*find(entries, strip_byte_counts), i, strips_[i].bytes);
    }
    for (const Entry &entry : entries) {
        if (!entry.inside()) tiff.put(entry.field, 4, tiff.get(entry.field, 4) - short_end() + directory_);
    }
    const File file = open_for_reading(path_);
    Replacement to(path_, file.get());
    to.copy(0, directory_);
    to.write(edited.data() + short_end(), edited.size() - short_end());
    to.commit();
    return true;
}

// Exiv2 wrote all anew: directories first, then the strips, each at an even place.
bool TiffExcerpt::replace_all(std::vector<uint8_t> edited, uint32_t pixels) const {
    TiffBytes tiff(edited, little_, 0);
    const std::vector<Entry> entries = tiff.entries(tiff.get(4, 4));
    uint64_t place = pixels;
    for (uint32_t i = 0; i < strips_.size(); ++i) {
        tiff.set_number(*find(entries, strip_offsets), i, static_cast<uint32_t>(place));
        tiff.set_number(*find(entries, strip_byte_counts), i, strips_[i].bytes);
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
    return excerpt->make() ? std::move(excerpt) : nullptr;
}

}  // namespace codec

}  // namespace lensprof
