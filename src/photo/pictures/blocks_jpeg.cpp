// Metadata in the segments before the pixels of a JPEG (ITU-T T.81, annex B).
#include <algorithm>
#include <map>
#include <stdexcept>
#include <string_view>

#include "photo/pictures/exif_layout.hpp"
#include "photo/pictures/file_boxes.hpp"
#include "photo/pictures/photoshop_block.hpp"
#include "photo/pictures/picture_blocks.hpp"

namespace lensprof {

namespace codec {

namespace {

using namespace std::string_view_literals;

constexpr uint8_t marker_app0 = 0xe0, marker_app1 = 0xe1, marker_app2 = 0xe2, marker_app13 = 0xed, marker_com = 0xfe,
                  marker_scan = 0xda;
constexpr uint64_t max_head_bytes = uint64_t(64) << 20;
constexpr std::string_view exif_mark = "Exif\0\0"sv, xmp_mark = "http://ns.adobe.com/xap/1.0/\0"sv,
                           extension_mark = "http://ns.adobe.com/xmp/extension/\0"sv, icc_mark = "ICC_PROFILE\0"sv,
                           photoshop_mark = "Photoshop 3.0\0"sv;

struct Segment {
    uint8_t marker = 0;
    std::vector<uint8_t> content;

    bool is(uint8_t wanted, std::string_view mark) const {
        return marker == wanted && content.size() >= mark.size()
               && std::equal(mark.begin(), mark.end(), content.begin(),
                             [](char a, uint8_t b) { return static_cast<uint8_t>(a) == b; });
    }

    std::vector<uint8_t> after(std::string_view mark) const {
        return {content.begin() + static_cast<std::ptrdiff_t>(mark.size()), content.end()};
    }

    // SOF of any coding: C4, C8 and CC are other markers.
    bool is_frame() const {
        return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc
               && content.size() >= 5;
    }
};

struct SegmentList {
    std::vector<Segment> segments;
    uint64_t scan = 0;  // position of the first scan
};

SegmentList read_segments(const ReadAt &read) {
    SegmentList list;
    std::vector<uint8_t> head;
    for (uint64_t at = 2; at < max_head_bytes && read(at, 4, head) && head[0] == 0xff;) {
        if (head[1] == 0xff) {  // any number of these may precede a marker
            at += 1;
            continue;
        }
        const size_t bytes = static_cast<size_t>(big_endian(&head[2], 2));
        if (head[1] < 0xc0 || (head[1] >= 0xd0 && head[1] <= 0xd9) || bytes < 2) break;
        if (head[1] == marker_scan) {
            list.scan = at;
            return list;
        }
        Segment segment{head[1], {}};
        if (!read(at + 4, bytes - 2, segment.content)) break;
        list.segments.push_back(std::move(segment));
        at += 2 + bytes;
    }
    throw std::runtime_error("the JPEG is damaged or truncated before its pixels");
}

// A profile is spread over segments, each with its number and their count. Empty if one is missing.
std::vector<uint8_t> join_profile(const std::vector<Segment> &segments) {
    std::map<uint8_t, std::vector<uint8_t>> parts;
    size_t count = 0;
    for (const Segment &segment : segments) {
        if (!segment.is(marker_app2, icc_mark) || segment.content.size() < icc_mark.size() + 2) continue;
        const std::vector<uint8_t> rest = segment.after(icc_mark);
        count = rest[1];
        parts[rest[0]].assign(rest.begin() + 2, rest.end());
    }
    std::vector<uint8_t> profile;
    if (parts.size() == count)
        for (const auto &part : parts) profile.insert(profile.end(), part.second.begin(), part.second.end());
    return profile;
}

std::vector<uint8_t> join_resources(const std::vector<Segment> &segments) {
    std::vector<uint8_t> resources;
    for (const Segment &segment : segments) {
        if (!segment.is(marker_app13, photoshop_mark)) continue;
        const std::vector<uint8_t> part = segment.after(photoshop_mark);
        resources.insert(resources.end(), part.begin(), part.end());
    }
    return resources;
}

class JpegBytes {
public:
    void add(const std::vector<uint8_t> &more) { bytes.insert(bytes.end(), more.begin(), more.end()); }

    void add_segment(uint8_t marker, std::string_view mark, const std::vector<uint8_t> &content, const char *name) {
        const size_t size = 2 + mark.size() + content.size();
        if (size > 0xffff) throw std::runtime_error(std::string(name) + " is larger than a JPEG can hold");
        bytes.insert(bytes.end(), {0xff, marker, static_cast<uint8_t>(size >> 8), static_cast<uint8_t>(size)});
        bytes.insert(bytes.end(), mark.begin(), mark.end());
        add(content);
    }

    std::vector<uint8_t> bytes;
};

bool is_replaced(const Segment &segment, bool has_comment) {
    return segment.is(marker_app1, exif_mark) || segment.is(marker_app1, xmp_mark)
           || segment.is(marker_app1, extension_mark) || segment.is(marker_app13, photoshop_mark)
           || (has_comment && segment.marker == marker_com);
}

}  // namespace

PictureBlocks read_jpeg_blocks(const ReadAt &read) {
    const SegmentList list = read_segments(read);
    PictureBlocks blocks;
    blocks.mime_type = "image/jpeg";
    blocks.is_of_camera = true;
    for (const Segment &segment : list.segments) {
        if (segment.is_frame()) {
            blocks.height = static_cast<uint32_t>(big_endian(&segment.content[1], 2));
            blocks.width = static_cast<uint32_t>(big_endian(&segment.content[3], 2));
        } else if (segment.is(marker_app1, exif_mark) && blocks.exif_block.empty()) {
            blocks.exif_block = segment.after(exif_mark);
        } else if (segment.is(marker_app1, xmp_mark) && blocks.xmp.empty()) {
            blocks.xmp.assign(segment.content.begin() + static_cast<std::ptrdiff_t>(xmp_mark.size()),
                              segment.content.end());
        } else if (segment.marker == marker_com && blocks.comment.empty()) {
            blocks.comment.assign(segment.content.begin(), segment.content.end());
        }
    }
    while (!blocks.comment.empty() && blocks.comment.back() == '\0') blocks.comment.pop_back();
    blocks.exif = read_exif(blocks.exif_block);
    blocks.iptc = iptc_of(join_resources(list.segments));
    blocks.icc = join_profile(list.segments);
    return blocks;
}

std::vector<uint8_t> jpeg_with(const std::vector<uint8_t> &file, const PictureBlocks &blocks) {
    const SegmentList list = read_segments([&](uint64_t offset, size_t count, std::vector<uint8_t> &part) {
        if (offset > file.size() || count > file.size() - offset) return false;
        part.assign(&file[static_cast<size_t>(offset)], &file[static_cast<size_t>(offset)] + count);
        return true;
    });
    JpegBytes jpeg{{0xff, 0xd8}};
    auto segment = list.segments.begin();
    for (; segment != list.segments.end() && segment->marker == marker_app0; ++segment)
        jpeg.add_segment(segment->marker, {}, segment->content, "a segment");
    const std::vector<uint8_t> exif = exif_block(blocks.exif),
                               resources = with_iptc(join_resources(list.segments), blocks.iptc);
    if (!exif.empty()) jpeg.add_segment(marker_app1, exif_mark, exif, "EXIF");
    if (!blocks.xmp.empty()) jpeg.add_segment(marker_app1, xmp_mark, {blocks.xmp.begin(), blocks.xmp.end()}, "XMP");
    if (!resources.empty()) jpeg.add_segment(marker_app13, photoshop_mark, resources, "IPTC");
    if (!blocks.comment.empty())
        jpeg.add_segment(marker_com, {}, {blocks.comment.begin(), blocks.comment.end()}, "the comment");
    for (; segment != list.segments.end(); ++segment)
        if (!is_replaced(*segment, !blocks.comment.empty()))
            jpeg.add_segment(segment->marker, {}, segment->content, "a segment");
    jpeg.bytes.insert(jpeg.bytes.end(), file.begin() + static_cast<std::ptrdiff_t>(list.scan), file.end());
    return jpeg.bytes;
}

}  // namespace codec

}  // namespace lensprof
