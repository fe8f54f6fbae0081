#include "photo/pictures/other_parts.hpp"

#include <cstdint>
#include <cstring>
#include <fstream>

#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/shell_word.hpp"
#include "photo/pictures/codec.hpp"
#include "photo/pictures/coded_file.hpp"
#include "photo/pictures/coded_kind.hpp"
#include "photo/pictures/file_boxes.hpp"
#include "photo/pictures/picture_excerpt.hpp"
#include "photo/pictures/picture_stack.hpp"
#include "photo/pictures/raw_kind.hpp"
#include "photo/pictures/tiff_pages.hpp"

namespace lensprof {
namespace {

enum class Kind {
    other,
    jpeg,
    tiff,
    png,
    heif,
    jxl,
    fits
};

Kind kind_of(const std::string &path) {
    if (raw_kind(path)) return Kind::other;
    if (const auto coded = coded_kind(path))
        return coded->format == FileFormat::heif   ? Kind::heif
               : coded->format == FileFormat::jxl  ? Kind::jxl
               : coded->format == FileFormat::fits ? Kind::fits
                                                   : Kind::other;
    const codec::File file = codec::open_for_reading(path);
    std::vector<uint8_t> start;
    if (!codec::read_at(file.get(), 0, 4, start)) return Kind::other;
    if (start[0] == 0xff && start[1] == 0xd8) return Kind::jpeg;
    if (std::memcmp(start.data(), "\x89PNG", 4) == 0) return Kind::png;
    return (start[0] == 'I' && start[1] == 'I') || (start[0] == 'M' && start[1] == 'M') ? Kind::tiff : Kind::other;
}

// A copy, which may be of a format that is not read.
bool is_jpeg(const std::string &path) {
    char start[2] = {};
    return std::ifstream(path, std::ios::binary).read(start, sizeof start) && start[0] == '\xff' && start[1] == '\xd8';
}

// ISO/IEC 18181-2: the box of a gain map.
bool has_gain_map_of_jxl(const std::string &path) {
    bool is_found = false;
    codec::each_box(codec::open_for_reading(path).get(), [&](const std::string &type, uint64_t, uint64_t) {
        is_found |= type == "jhgm";
        return !is_found;
    });
    return is_found;
}

// Frames of an animation (PNG 3, 11.3.6.1: acTL, before the pixels); 0 for a still picture.
uint32_t png_frames(const std::string &path) {
    const codec::File file = codec::open_for_reading(path);
    std::vector<uint8_t> head;
    for (uint64_t offset = 8; codec::read_at(file.get(), offset, 12, head);
         offset += 12 + codec::big_endian(&head[0], 4)) {
        if (std::memcmp(&head[4], "acTL", 4) == 0) return static_cast<uint32_t>(codec::big_endian(&head[8], 4));
        if (std::memcmp(&head[4], "IDAT", 4) == 0) return 0;
    }
    return 0;
}

// `what`: before the number of pictures.
SeveralPictures several_in_stack(const std::string &path, const char *what, const char *pictures) {
    const size_t count = picture_stack(path).pages.size();
    if (count < 2) return {};
    return {format("%s %zu %s", what, count, pictures), "save them as files of their own first, and give these", true};
}

SeveralPictures several_of_tiff(const std::string &path) {
    const codec::TiffPages found = codec::tiff_pages(path);
    if (found.pages == 1) return several_in_stack(path, "is a stack of", "slices");  // of ImageJ
    if (found.pages < 2) return {};
    return {format("has %s%u pages", found.has_more ? "more than " : "", found.pages),
            "split it first, for example with `tiffsplit " + shell_word(path) + " page_`, and give its pages", true};
}

SeveralPictures several_of_jpeg(const std::string &path) {
    const uint32_t views = codec::jpeg_views(path);
    if (views < 2) return {};
    return {format("has %u pictures of one subject (stereo, panorama or several angles)", views),
            "extract them first, for example with `exiftool -trailer:all= -o first.jpg " + shell_word(path)
                + "` and `exiftool -b -MPImage2 " + shell_word(path) + " > second.jpg`, and give these"};
}

SeveralPictures several_of_heif(const std::string &path) {
    const codec::HeifParts parts = codec::heif_parts(path, coded_kind(path)->name);
    const std::string next_step = "save its pictures as files of their own first, for example with `heif-convert "
                                  + shell_word(path) + " picture.png`, and give these";
    if (parts.is_sequence) return {"is a sequence of frames", next_step};
    if (parts.pictures < 2) return {};
    return {format("has %u pictures", parts.pictures), next_step};
}

}  // namespace

SeveralPictures several_pictures(const std::string &path) {
    switch (kind_of(path)) {
    case Kind::jpeg: return several_of_jpeg(path);
    case Kind::tiff: return several_of_tiff(path);
    case Kind::heif: return several_of_heif(path);
    case Kind::fits: return several_in_stack(path, "has", "planes");
    case Kind::png:
        if (const uint32_t frames = png_frames(path); frames > 1)
            return {format("is an animation of %u frames", frames),
                    "save its frames as files of their own first, for example with `ffmpeg -i " + shell_word(path)
                        + " frame_%04d.png`, and give these"};
        return {};
    default: return {};
    }
}

void note_several(const std::vector<std::string> &files, Events &events, const std::string &stack_advice) {
    for (const std::string &file : files) {
        try {
            const SeveralPictures several = several_pictures(file);
            if (!several.what.empty())
                events.note(file, several.what + "; only the first is used. To use all, " + several.next_step
                                      + (several.is_stack ? stack_advice : std::string()));
        } catch (const Failure &failure) {  // reported when it is read
            if (failure.group() == LENSPROF_ERROR_CANCELLED) throw;
        }
    }
}

OtherParts other_parts(const std::string &source, const std::string &target) {
    OtherParts parts;
    switch (kind_of(source)) {
    case Kind::jpeg: {
        const codec::JpegParts jpeg = codec::jpeg_parts(source);
        parts.left_out = jpeg.left_out;
        if (is_jpeg(target))
            parts.kept = jpeg.kept;
        else
            parts.left_out.insert(parts.left_out.end(), jpeg.kept_names.begin(), jpeg.kept_names.end());
        break;
    }
    case Kind::tiff: {
        const codec::TiffPages pages = codec::tiff_pages(source);
        if (pages.has_layers) parts.left_out.push_back("its layers");
        if (pages.has_mask) parts.left_out.push_back("a mask");
        if (pages.is_damaged) parts.left_out.push_back("further pages, whose directory is damaged");
        break;
    }
    case Kind::heif: parts.left_out = codec::heif_parts(source, coded_kind(source)->name).names; break;
    case Kind::jxl:
        if (has_gain_map_of_jxl(source)) parts.left_out.push_back("a gain map (HDR)");
        break;
    default: break;
    }
    return parts;
}

void append_kept_parts(const std::string &source, const std::string &target) {
    if (kind_of(source) == Kind::jpeg && is_jpeg(target))
        codec::append_jpeg_parts(codec::jpeg_parts(source), source, target);
}

}  // namespace lensprof
