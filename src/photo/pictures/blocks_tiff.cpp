// Metadata of a TIFF: fields of its main directory, and directories of their own. New directories are appended, so that
// pixels and whatever else the file holds stay where they are.
#include <algorithm>
#include <stdexcept>

#include "photo/pictures/codec.hpp"
#include "photo/pictures/exif_layout.hpp"
#include "photo/pictures/exif_tags.hpp"
#include "photo/pictures/exif_value.hpp"
#include "photo/pictures/photoshop_block.hpp"
#include "photo/pictures/picture_blocks.hpp"
#include "photo/pictures/picture_excerpt.hpp"
#include "photo/pictures/tiff_tags.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

namespace codec {

namespace {

TiffReader reader_of_file(std::FILE *file) {
    return {file_bytes(file), [file](uint64_t offset, uint8_t *bytes, size_t count) {
                if (!system::seek(file, static_cast<int64_t>(offset), SEEK_SET)
                    || std::fread(bytes, 1, count, file) != count)
                    throw UnusableTiff(TiffDefect::cut_off);
            }};
}

// The full picture: the last directory that is stated to be it and not a JPEG, else the first directory.
void read_size(TiffReader &reader, const TiffDirectory &first, PictureBlocks &blocks) {
    TiffDirectory primary = first;
    const auto is_primary = [&](const TiffDirectory &directory) {
        return reader.number(directory, exif_tags::subfile_type.tag, 1) == 0;
    };
    try {
        if (!is_primary(first) || first.find(tag_jpeg_offset))
            for (const uint64_t child : reader.children(first)) {
                const TiffDirectory directory = reader.directory(child);
                if (!is_primary(directory)) continue;
                primary = directory;
                if (!directory.find(tag_jpeg_offset)) break;
            }
    } catch (const UnusableTiff &) {  // its reader reports the error
    }
    blocks.width = reader.number(primary, exif_tags::image_width.tag, 0);
    blocks.height = reader.number(primary, exif_tags::image_length.tag, 0);
}

std::vector<uint8_t> bytes_of_field(const Exif &exif, ExifTag tag) {
    const ExifField *field = exif.find(tag);
    return field ? field->bytes : std::vector<uint8_t>();
}

PictureBlocks read_blocks_of(TiffReader &reader, const TiffDirectory &first) {
    PictureBlocks blocks;
    blocks.mime_type = "image/tiff";
    blocks.exif = read_exif(reader, first);
    const std::vector<uint8_t> packet = bytes_of_field(blocks.exif, exif_tags::xmp);
    blocks.xmp.assign(packet.begin(), packet.end());
    blocks.iptc = bytes_of_field(blocks.exif, exif_tags::iptc);
    if (blocks.iptc.empty()) blocks.iptc = iptc_of(bytes_of_field(blocks.exif, exif_tags::photoshop));
    blocks.icc = bytes_of_field(blocks.exif, exif_tags::colour_profile);
    read_size(reader, first, blocks);
    return blocks;
}

// A CR2 has no directory of its full size.
bool is_cr2(std::FILE *file) {
    std::vector<uint8_t> mark;
    return read_at(file, 8, 2, mark) && mark[0] == 'C' && mark[1] == 'R';
}

// Where the pixels end; the end of the file if it may hold more than its first picture.
uint64_t pixels_end(TiffReader &reader, const TiffDirectory &first, uint64_t size) {
    if (first.next != 0) return size;
    for (const uint16_t tag : {tag_sub_directories, tag_jpeg_offset, tag_kodak_directory, exif_tags::dng_version.tag})
        if (first.find(tag)) return size;
    uint64_t end = tiff_header_bytes;
    for (const auto &[offsets_tag, counts_tag] :
         {std::pair(tag_strip_offsets, tag_strip_bytes), {tag_tile_offsets, tag_tile_bytes}}) {
        const std::vector<uint32_t> offsets = reader.numbers(first, offsets_tag),
                                    counts = reader.numbers(first, counts_tag);
        if (offsets.size() != counts.size()) return size;
        for (size_t i = 0; i < offsets.size(); ++i) end = std::max(end, uint64_t(offsets[i]) + counts[i]);
    }
    return std::min(end, size);
}

// The bytes of the file that stay: without old directories and values if these follow all pixels, as most programs
// write them. All other values stay where they are.
uint64_t kept_bytes(TiffReader &reader, const TiffDirectory &first, uint64_t size, Exif &exif) {
    bool is_whole = pixels_end(reader, first, size) > exif.start;
    for (auto &all : exif.fields)
        for (const ExifField &field : all) is_whole = is_whole || field.bytes.empty();
    if (is_whole) return size;
    for (auto &all : exif.fields)
        for (ExifField &field : all) field.place = 0;
    return exif.start;
}

void set_bytes(Exif &exif, ExifTag tag, uint16_t type, const std::vector<uint8_t> &bytes) {
    if (bytes != bytes_of_field(exif, tag)) exif.set(tag, type, static_cast<uint32_t>(bytes.size()), bytes);
}

}  // namespace

PictureBlocks read_tiff_blocks(const std::string &path) {
    const File file = open_for_reading(path);
    TiffReader reader = reader_of_file(file.get());
    PictureBlocks blocks = read_blocks_of(reader, reader.first());
    if (!is_cr2(file.get())) return blocks;
    blocks.width = static_cast<uint32_t>(in_range(read_number(blocks.exif, {exif_tags::pixel_width}), 1e6).value_or(0));
    blocks.height =
        static_cast<uint32_t>(in_range(read_number(blocks.exif, {exif_tags::pixel_height}), 1e6).value_or(0));
    return blocks;
}

void write_tiff_blocks(const std::string &path, PictureBlocks blocks) {
    const File file = open_for_reading(path);
    TiffReader reader = reader_of_file(file.get());
    const TiffDirectory first = reader.first();
    const uint64_t size = file_bytes(file.get());
    set_bytes(blocks.exif, exif_tags::xmp, tiff_byte, {blocks.xmp.begin(), blocks.xmp.end()});
    set_bytes(blocks.exif, exif_tags::iptc, tiff_undefined, blocks.iptc);
    const uint64_t kept = kept_bytes(reader, first, size, blocks.exif), start = (kept + 1) & ~uint64_t(1);
    const std::vector<uint8_t> directories = appended_exif(blocks.exif, start, first.next);
    if (start + directories.size() > UINT32_MAX) throw std::runtime_error("the TIFF would be larger than 4 GiB");
    uint8_t head[tiff_header_bytes];
    std::copy_n(reader.order().big ? "MM\0*" : "II*\0", 4, head);
    reader.order().put(head + 4, 4, static_cast<uint32_t>(start));
    Replacement to(path, file.get());
    to.write(head, sizeof head);
    to.copy(tiff_header_bytes, kept - tiff_header_bytes);
    to.write("", static_cast<size_t>(start - kept));
    to.write(directories.data(), directories.size());
    to.commit();
}

}  // namespace codec

}  // namespace lensprof
