#include "photo/pictures/copied_metadata.hpp"

#include <algorithm>
#include <iterator>

#include "photo/pictures/exif_tags.hpp"
#include "photo/pictures/note_place.hpp"
#include "photo/pictures/part_tags.hpp"

namespace lensprof {

namespace {

// Tags of the main directory that describe how pixels are stored, point to other parts of the file, or hold data kept
// elsewhere (ICC, XMP, IPTC).
bool is_structure(uint16_t tag) {
    static const uint16_t tags[] = {254, 255, 256, 257, 258, 259,   262,   263,   264,   265,   266,  273, 277,
                                    278, 279, 280, 281, 284, 288,   289,   290,   291,   292,   293,  317, 320,
                                    321, 322, 323, 324, 325, 326,   327,   328,   330,   332,   334,  336, 338,
                                    339, 340, 341, 342, 347, 512,   513,   514,   515,   517,   518,  519, 520,
                                    521, 529, 530, 532, 700, 33723, 34377, 34665, 34675, 34853, 37724};
    return std::binary_search(std::begin(tags), std::end(tags), tag);
}

// Tags of the main directory that describe a mosaic and a DNG; developed pictures do not have them.
bool is_of_raw(uint16_t tag) { return tag == 33421 || tag == 33422 || (tag >= 50706 && tag <= 52600); }

bool is_kept(uint16_t tag, const Exif &copy, bool to_tiff) {
    static const uint16_t resolution[] = {282, 283, 296};
    constexpr uint16_t chroma_position = 531;  // of samples that a TIFF does not have here
    if (to_tiff && tag == chroma_position) return false;
    if (to_tiff && std::find(std::begin(resolution), std::end(resolution), tag) != std::end(resolution))
        return !copy.find(exif_tags::x_resolution);
    return !is_structure(tag);
}

}  // namespace

void copy_exif(const PictureBlocks &source, bool from_raw, PictureBlocks &copy) {
    const bool to_tiff = copy.mime_type == "image/tiff";
    const Exif before = copy.exif;
    if (!to_tiff) set_order(copy.exif, source.exif.order);
    for (size_t i = 0; i < exif_groups; ++i)
        for (const ExifField &field : source.exif.fields[i]) {
            const ExifGroup group = static_cast<ExifGroup>(i);
            const bool is_image = group == ExifGroup::image;
            if (is_image && ((from_raw && is_of_raw(field.tag)) || !is_kept(field.tag, before, to_tiff))) continue;
            ExifField copied = in_order(field, source.exif.order, copy.exif.order);
            copy.exif.set({group, field.tag}, field.type, field.count, std::move(copied.bytes));
        }
    if (source.exif.find(exif_tags::maker_note)) copy.exif.note_place = source.exif.note_place;
    for (const auto &[tag, size] :
         {std::pair(exif_tags::pixel_width, copy.width), {exif_tags::pixel_height, copy.height}})
        if (copy.exif.find(tag)) copy.exif.set_number(tag, tiff_long, size);
}

void edit_copied_xmp(bool keeps_parts, const PictureBlocks &copy, Xmp &xmp) {
    codec::remove_extended_tags(xmp);
    xmp.remove_if([](const std::string &space, const std::string &name) {
        return space == xmp_names::extension || (space == xmp_names::xmp && name.rfind("Thumbnails", 0) == 0);
    });
    if (!keeps_parts) codec::remove_part_tags(xmp);
    const std::string width = std::to_string(copy.width), height = std::to_string(copy.height);
    xmp.replace(xmp_names::exif, "PixelXDimension", width);
    xmp.replace(xmp_names::exif, "PixelYDimension", height);
    xmp.replace(xmp_names::tiff, "ImageWidth", width);
    xmp.replace(xmp_names::tiff, "ImageLength", height);
    xmp.replace(xmp_names::dublin_core, "format", copy.mime_type);
}

void remove_gain_map(Exif &exif) {
    const ExifField *note = exif.find(exif_tags::maker_note);
    if (!note) return;
    std::vector<uint8_t> bytes = note->bytes;
    if (remove_gain_map_entries(bytes)) exif.set(exif_tags::maker_note, note->type, note->count, std::move(bytes));
}

}  // namespace lensprof
