#include "photo/pictures/jpeg_parts.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>

#include "photo/base/events.hpp"
#include "photo/pictures/codec.hpp"
#include "photo/pictures/picture_excerpt.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

namespace codec {

namespace {

using namespace std::string_view_literals;

constexpr uint64_t head_max_bytes = uint64_t(64) << 20;  // before the pixels
constexpr uint64_t file_max_bytes = UINT32_MAX;          // the offsets of the index have 32 bits
constexpr size_t block_bytes = size_t(1) << 18;

constexpr uint8_t end_of_image = 0xd9, start_of_scan = 0xda, app1 = 0xe1, app2 = 0xe2;
constexpr std::string_view gain_map_mark = "urn:iso:std:iso:ts:21496:-1"sv;

std::string_view text_of(const std::vector<uint8_t> &bytes) {
    return {reinterpret_cast<const char *>(bytes.data()), bytes.size()};
}

bool starts_with(std::string_view text, std::string_view start) { return text.substr(0, start.size()) == start; }
bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

// Reads a file byte by byte, in blocks.
class Scanner {
public:
    Scanner(std::FILE *file, uint64_t start) : file_(file), origin_(start) {
        if (!system::seek(file, static_cast<int64_t>(start), SEEK_SET)) is_at_end_ = true;
    }

    uint64_t position() const { return origin_ + next_; }

    int get() { return next_ < block_.size() || fill() ? block_[next_++] : -1; }

    // Skips to the next 0xff and over it; false at the end.
    bool find_marker() {
        while (next_ < block_.size() || fill()) {
            const void *found = std::memchr(&block_[next_], 0xff, block_.size() - next_);
            next_ =
                found ? static_cast<size_t>(static_cast<const uint8_t *>(found) - block_.data()) + 1 : block_.size();
            if (found) return true;
        }
        return false;
    }

    // Appends `count` bytes; false if the file ends before.
    bool read(size_t count, std::vector<uint8_t> &bytes) {
        while (count > 0 && (next_ < block_.size() || fill())) {
            const size_t step = std::min(count, block_.size() - next_);
            const auto from = block_.begin() + static_cast<std::ptrdiff_t>(next_);
            bytes.insert(bytes.end(), from, from + static_cast<std::ptrdiff_t>(step));
            next_ += step, count -= step;
        }
        return count == 0;
    }

    void skip(size_t count) {
        while (count > 0 && (next_ < block_.size() || fill())) {
            const size_t step = std::min(count, block_.size() - next_);
            next_ += step, count -= step;
        }
    }

private:
    bool fill() {
        if (is_at_end_) return false;
        stop_if_cancelled();
        origin_ += block_.size();
        block_.resize(block_bytes);
        block_.resize(std::fread(block_.data(), 1, block_.size(), file_));
        next_ = 0;
        is_at_end_ = block_.empty();
        return !is_at_end_;
    }

    std::FILE *file_;
    uint64_t origin_;  // position of the block in the file
    std::vector<uint8_t> block_;
    size_t next_ = 0;
    bool is_at_end_ = false;
};

// What the segments before the pixels state.
struct Head {
    uint64_t scan = 0;  // where the pixels start; 0 = nowhere
    bool has_index = false, has_extended_xmp = false, lists_parts = false;
    uint64_t index_start = 0;  // of the byte order mark of the index
    std::optional<std::vector<MpPicture>> pictures;
    std::vector<uint8_t> gain_map_segment;

    // Whether an index lists more than the first picture, as far as it can be read. Some cameras write an index with
    // entries for previews that they then do not write.
    bool lists_others() const {
        if (!has_index || !pictures || pictures->empty()) return has_index;
        return std::any_of(pictures->begin() + 1, pictures->end(), [](const MpPicture &other) { return other.bytes; });
    }
};

void take_segment(uint8_t marker, uint64_t offset, const std::vector<uint8_t> &segment, Head &head) {
    const std::string_view content = text_of(segment).substr(4);
    if (marker == app1 && starts_with(content, "http://ns.adobe.com/xmp/extension/"sv)) head.has_extended_xmp = true;
    // XMP of Google, where containers and the video of a motion photo are described
    if (marker == app1 && starts_with(content, "http://ns.adobe.com/xap/"sv))
        head.lists_parts |= contains(content, "/photos/1.0/container/"sv) || contains(content, "MicroVideo"sv)
                            || contains(content, "MotionPhoto"sv);
    if (marker == app2 && starts_with(content, gain_map_mark)) head.gain_map_segment = segment;
    if (marker != app2 || !starts_with(content, "MPF\0"sv) || head.has_index) return;
    head.has_index = true;
    head.index_start = offset + mp_index_start;
    head.pictures = read_mp_index({segment.begin() + mp_index_start, segment.end()});
}

// The segments before the first scan (ITU-T T.81, annex B). Any number of 0xff may precede a marker.
Head read_head(std::FILE *file) {
    Head head;
    Scanner scanner(file, 0);
    if (scanner.get() != 0xff || scanner.get() != 0xd8) return head;
    while (scanner.position() < head_max_bytes && scanner.get() == 0xff) {
        int marker = scanner.get();
        while (marker == 0xff) marker = scanner.get();
        const uint64_t offset = scanner.position() - 2;
        const int high = scanner.get(), length = high << 8 | scanner.get();
        if (marker < 0xc0 || (marker >= 0xd0 && marker <= end_of_image) || length < 2) break;
        if (marker == start_of_scan) {
            head.scan = offset;
            break;
        }
        const size_t bytes = static_cast<size_t>(length) - 2;
        if (marker != app1 && marker != app2) {
            scanner.skip(bytes);
            continue;
        }
        std::vector<uint8_t> segment = {0xff, static_cast<uint8_t>(marker), static_cast<uint8_t>(high),
                                        static_cast<uint8_t>(length)};
        if (scanner.read(bytes, segment)) take_segment(static_cast<uint8_t>(marker), offset, segment, head);
    }
    return head;
}

// Where the picture ends whose first scan is at `scan`; 0 if nowhere. Within coded pixels 0xff is followed by 0 or the
// number of a restart; what else follows it is a marker.
uint64_t end_of_picture(std::FILE *file, uint64_t scan) {
    Scanner scanner(file, scan);
    while (scanner.find_marker()) {
        int marker = scanner.get();
        while (marker == 0xff) marker = scanner.get();
        if (marker == end_of_image) return scanner.position();
        if (marker < 0xc0 || (marker >= 0xd0 && marker <= 0xd8)) continue;
        const int high = scanner.get(), length = high << 8 | scanner.get();
        if (length < 2) return 0;
        scanner.skip(static_cast<size_t>(length) - 2);
    }
    return 0;
}

// The rest of a JPEG file, after its picture.
class Rest {
public:
    Rest(std::FILE *file, uint64_t start, uint64_t end) : file_(file), start_(start), end_(end) {}

    uint64_t start() const { return start_; }
    uint64_t end() const { return end_; }
    bool is_empty() const { return end_ - start_ == 0; }

    // Bytes at `position`, fewer at the end of the file.
    std::string_view read(uint64_t position, uint64_t count) {
        const uint64_t limit = position < end_ ? std::min(count, end_ - position) : 0;
        if (!read_at(file_, position, static_cast<size_t>(limit), bytes_)) bytes_.clear();
        return text_of(bytes_);
    }

    Rest part(const ByteRange &range) const { return {file_, range.start, range.end}; }

    bool is_padding() {
        const std::string_view bytes = read(start_, block_bytes);
        return end_ - start_ <= block_bytes
               && (bytes.size() < 4 || bytes.find_first_not_of(bytes[0]) == std::string_view::npos);
    }

    bool is_jpeg(const JpegPart &part) {
        return part.start >= start_ && part.start <= end_ && part.picture.bytes <= end_ - part.start
               && part.picture.bytes > 4 && read(part.start, 3) == "\xff\xd8\xff"sv;
    }

private:
    std::FILE *file_;
    uint64_t start_, end_;
    std::vector<uint8_t> bytes_;
};

bool overlap(std::vector<JpegPart> parts) {
    std::sort(parts.begin(), parts.end(), [](const JpegPart &a, const JpegPart &b) { return a.start < b.start; });
    return std::adjacent_find(parts.begin(), parts.end(),
                              [](const JpegPart &a, const JpegPart &b) { return a.start + a.picture.bytes > b.start; })
           != parts.end();
}

// The pictures after the first one, at the offsets of the index, or, if a program changed the file without updating
// them, one after the other from the end of the first picture. Empty if the index fits neither.
std::vector<JpegPart> locate(const Head &head, Rest &rest) {
    std::vector<JpegPart> stated, following;
    uint64_t next = rest.start();
    for (size_t i = 1; i < head.pictures->size(); ++i) {
        const MpPicture &picture = (*head.pictures)[i];
        if (picture.bytes == 0) continue;  // a preview that the camera did not write
        stated.push_back({picture, head.index_start + picture.offset});
        following.push_back({picture, next});
        next += picture.bytes;
    }
    for (const auto &parts : {stated, following})
        if (!overlap(parts)
            && std::all_of(parts.begin(), parts.end(), [&](const JpegPart &part) { return rest.is_jpeg(part); }))
            return parts;
    return {};
}

std::string name_of(const JpegPart &part, Rest &rest) {
    if (part.picture.is_preview()) return "a preview of the uncorrected picture";
    const std::string_view bytes = rest.read(part.start, std::min<uint64_t>(part.picture.bytes, block_bytes));
    const bool is_gain_map = part.picture.is_gain_map() || contains(bytes, "hdr-gain-map"sv)
                             || contains(bytes, "hdrgainmap"sv) || contains(bytes, gain_map_mark);
    return is_gain_map ? "a gain map (HDR)" : "another picture";
}

// The rest without the previews, which show the uncorrected picture.
std::vector<ByteRange> without_previews(const Rest &rest, const std::vector<JpegPart> &parts) {
    std::vector<ByteRange> previews, kept;
    for (const JpegPart &part : parts)
        if (part.picture.is_preview()) previews.push_back({part.start, part.start + part.picture.bytes});
    std::sort(previews.begin(), previews.end(),
              [](const ByteRange &a, const ByteRange &b) { return a.start < b.start; });
    uint64_t next = rest.start();
    for (const ByteRange &preview : previews) {
        if (preview.start > next) kept.push_back({next, preview.start});
        next = std::max(next, preview.end);
    }
    if (next < rest.end()) kept.push_back({next, rest.end()});
    return kept;
}

// What no index lists: what the metadata of phones refer to is kept.
void take_unlisted(const Head &head, Rest rest, JpegParts &parts) {
    const bool is_video = rest.read(rest.start() + 4, 4) == "ftyp"sv,
               is_jpeg = rest.read(rest.start(), 3) == "\xff\xd8\xff"sv;
    const std::string name = is_video  ? "a video after the picture"
                             : is_jpeg ? "another picture after the first one"
                                       : std::to_string(rest.end() - rest.start()) + " bytes after the picture";
    const bool is_samsung = rest.read(rest.end() - std::min<uint64_t>(4, rest.end()), 4) == "SEFT"sv;
    const bool is_kept = head.lists_parts || is_samsung;
    if (is_kept) parts.kept.push_back({rest.start(), rest.end()});
    if (!rest.is_padding()) (is_kept ? parts.kept_names : parts.left_out).push_back(name);
}

void take_indexed(const Head &head, const std::vector<JpegPart> &located, Rest &rest, JpegParts &parts) {
    for (const JpegPart &part : located) {
        const std::string name = name_of(part, rest);
        (part.picture.is_preview() ? parts.left_out : parts.kept_names).push_back(name);
        if (!part.picture.is_preview()) parts.index.push_back(part);
    }
    const std::vector<ByteRange> others = without_previews(rest, located);
    if (parts.index.empty()) {
        for (const ByteRange &range : others) take_unlisted(head, rest.part(range), parts);
        return;
    }
    parts.kept = others;
    parts.index.insert(parts.index.begin(), {head.pictures->front(), 0});
    if (parts.index.size() == located.size() + 1) return;
    for (JpegPart &part : parts.index) part.picture.remove_dependence();  // numbers of the old index
}

// Where the kept byte at `position` of the old file is in the new one, from the end of its picture.
uint64_t moved(const std::vector<ByteRange> &kept, uint64_t position) {
    uint64_t before = 0;
    for (const ByteRange &range : kept) {
        if (position >= range.start && position < range.end) return before + position - range.start;
        before += range.end - range.start;
    }
    return before;
}

// Where new segments belong: after JFIF, EXIF and XMP.
uint64_t segments_end(std::FILE *file) {
    std::vector<uint8_t> start;
    uint64_t offset = 2;
    while (read_at(file, offset, 4, start) && start[0] == 0xff && (start[1] == 0xe0 || start[1] == app1))
        offset += 2 + (uint64_t(start[2]) << 8 | start[3]);
    return offset;
}

std::vector<uint8_t> new_index(const JpegParts &parts, uint64_t picture_bytes, uint64_t index_start) {
    std::vector<MpPicture> pictures;
    for (const JpegPart &part : parts.index) {
        MpPicture picture = part.picture;
        if (pictures.empty())
            picture.bytes = static_cast<uint32_t>(picture_bytes), picture.offset = 0;
        else
            picture.offset = static_cast<uint32_t>(picture_bytes + moved(parts.kept, part.start) - index_start);
        pictures.push_back(picture);
    }
    return mp_segment(pictures);
}

}  // namespace

uint32_t jpeg_views(const std::string &path) {
    const File file = open_for_reading(path);
    const Head head = read_head(file.get());
    if (!head.pictures) return 0;
    const auto views = std::count_if(head.pictures->begin(), head.pictures->end(),
                                     [](const MpPicture &picture) { return picture.is_view(); });
    return views < 2 ? 0 : static_cast<uint32_t>(views);
}

JpegParts jpeg_parts(const std::string &path) {
    const File file = open_for_reading(path);
    const uint64_t size = file_bytes(file.get());
    const Head head = read_head(file.get());
    JpegParts parts;
    parts.views = jpeg_views(path);
    if (head.has_extended_xmp) parts.left_out.push_back("extended XMP, which may hold a depth map or another picture");
    parts.end = head.scan ? end_of_picture(file.get(), head.scan) : 0;
    if (parts.end == 0 || parts.end > size) return parts;
    Rest rest(file.get(), parts.end, size);
    if (rest.is_empty()) return parts;
    const std::vector<JpegPart> located =
        head.lists_others() && head.pictures && !head.pictures->empty() ? locate(head, rest) : std::vector<JpegPart>();
    if (!located.empty())
        take_indexed(head, located, rest, parts);
    else if (head.lists_others() && !rest.is_padding())
        parts.left_out.push_back("what follows the picture, because its index (MPF) is damaged");
    else
        take_unlisted(head, rest, parts);
    if (size > file_max_bytes / 2) {
        parts.left_out.insert(parts.left_out.end(), parts.kept_names.begin(), parts.kept_names.end());
        parts.kept.clear(), parts.index.clear(), parts.kept_names.clear();
    }
    if (!parts.kept.empty()) parts.gain_map_segment = head.gain_map_segment;
    return parts;
}

void append_jpeg_parts(const JpegParts &parts, const std::string &source, const std::string &target) {
    if (parts.kept.empty()) return;
    const File from = open_for_reading(source), old = open_for_reading(target);
    const uint64_t place = segments_end(old.get()), size = file_bytes(old.get());
    const uint64_t index_bytes = parts.index.empty() ? 0 : mp_segment_bytes(parts.index.size());
    const uint64_t picture_bytes = size + parts.gain_map_segment.size() + index_bytes;
    Replacement to(target, old.get());
    to.copy(0, place);
    to.write(parts.gain_map_segment.data(), parts.gain_map_segment.size());
    if (!parts.index.empty()) {
        const uint64_t index_start = place + parts.gain_map_segment.size() + mp_index_start;
        const std::vector<uint8_t> index = new_index(parts, picture_bytes, index_start);
        to.write(index.data(), index.size());
    }
    to.copy(place, size - place);
    for (const ByteRange &range : parts.kept) to.copy_from(from.get(), range.start, range.end - range.start);
    to.commit();
}

}  // namespace codec

}  // namespace lensprof
