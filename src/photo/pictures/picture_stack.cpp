#include "photo/pictures/picture_stack.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include <pugixml.hpp>

#include "photo/pictures/coded_file.hpp"
#include "photo/pictures/coded_kind.hpp"
#include "photo/pictures/raw_kind.hpp"
#include "photo/pictures/tiff_handle.hpp"
#include "photo/pictures/tiff_pages.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr uint32_t most_images = 1u << 20;  // far more than a fit takes, of one channel, too

// The number of a line NAME=NUMBER; 0 without it.
uint32_t number_of_line(const std::string &text, const std::string &name) {
    size_t at = text.find("\n" + name + "=");
    if (at == std::string::npos) return 0;
    const unsigned long value = std::strtoul(text.c_str() + at + name.size() + 2, nullptr, 10);
    return static_cast<uint32_t>(std::min<unsigned long>(value, most_images));
}

// ImageJ orders channels before slices before frames.
StackDescription of_imagej(const std::string &text) {
    StackDescription stack;
    stack.images = number_of_line(text, "images");
    stack.channel_count = std::max(number_of_line(text, "channels"), 1u);
    return stack;
}

// The attributes of Pixels: DimensionOrder such as XYCZT, and the sizes. Samples of a colour pixel count as channels.
StackDescription of_ome(const std::string &text) {
    StackDescription stack;
    pugi::xml_document document;
    if (!document.load_buffer(text.data(), text.size())) return stack;
    const pugi::xml_node pixels = document.child("OME").child("Image").child("Pixels");
    const uint32_t samples = std::max(pixels.child("Channel").attribute("SamplesPerPixel").as_uint(1), 1u);
    stack.channel_count = std::clamp(pixels.attribute("SizeC").as_uint(1) / samples, 1u, most_images);
    const std::string order = pixels.attribute("DimensionOrder").as_string("XYCZT");
    for (size_t i = 2; i < order.size() && order[i] != 'C'; i++) {
        const char name[] = {'S', 'i', 'z', 'e', order[i], '\0'};
        stack.before_channel *= std::clamp(pixels.attribute(name).as_uint(1), 1u, most_images / stack.before_channel);
    }
    return stack;
}

}  // namespace

StackDescription stack_description(const Tiff &tiff) {
    const char *text = nullptr;
    if (!TIFFGetField(tiff.handle, TIFFTAG_IMAGEDESCRIPTION, &text) || !text) return {};
    if (std::strncmp(text, "ImageJ=", 7) == 0) return of_imagej(text);
    if (std::strstr(text, "<OME")) return of_ome(text);
    return {};
}

namespace {

// Slices of ImageJ without pages of their own: those that the file is long enough for.
void add_slices(const Tiff &tiff, uint32_t images, PictureStack &stack) {
    const uint64_t bytes = uint64_t(TIFFScanlineSize64(tiff.handle)) * tiff.field<uint32_t>(TIFFTAG_IMAGELENGTH, 0);
    const uint64_t offset = TIFFGetStrileOffset(tiff.handle, 0), end = tiff.file_bytes();
    const uint64_t fitting = bytes > 0 && end > offset ? (end - offset) / bytes : 1;
    for (uint32_t i = 1; i < std::min<uint64_t>(images, fitting); i++) stack.pages.push_back(i);
    stack.is_damaged |= stack.pages.size() < images;
}

PictureStack stack_of_tiff(const std::string &path) {
    PictureStack stack;
    const TiffPages found = tiff_pages(path, most_images);
    stack.pages = found.directories, stack.offsets = found.offsets, stack.is_damaged = found.is_damaged;
    const Tiff tiff(path, "rm");
    if (!tiff.handle) fail_damaged(path, tiff.message.text);
    const StackDescription description = stack_description(tiff);
    if (stack.pages.size() == 1 && description.images > 1) add_slices(tiff, description.images, stack);
    stack.offsets.resize(stack.pages.size(), 0);
    stack.channel_count = description.channel_count;
    for (uint32_t i = 0; i < stack.pages.size(); i++)
        stack.channels.push_back(i / description.before_channel % description.channel_count);
    return stack;
}

}  // namespace

}  // namespace codec

PictureStack picture_stack(const std::string &path) {
    PictureStack stack{{0}, {0}, {0}};
    if (raw_kind(path)) return stack;
    if (const auto coded = coded_kind(path)) {
        if (coded->format != FileFormat::fits) return stack;
        const codec::FitsPlanes planes = codec::fits_planes(path);
        stack.pages = planes.numbers, stack.others = planes.others, stack.is_damaged = planes.is_damaged;
        stack.offsets.assign(stack.pages.size(), 0), stack.channels.assign(stack.pages.size(), 0);
        return stack;
    }
    const codec::File file = codec::open_for_reading(path);
    char start[4] = {};
    const bool is_read = std::fread(start, 1, sizeof start, file.get()) == sizeof start;
    const bool is_tiff = is_read && (std::memcmp(start, "II", 2) == 0 || std::memcmp(start, "MM", 2) == 0);
    return is_tiff ? codec::stack_of_tiff(path) : stack;
}

}  // namespace lensprof
