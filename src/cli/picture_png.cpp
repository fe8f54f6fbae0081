/* PNG through libpng. Its errors leave by longjmp: see codec::guarded. */
#include "picture.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <new>

#include <png.h>

namespace lensprof {

namespace codec {

namespace {

constexpr char profile_name[] = "ICC profile";

/* For photographs zlib's level 3 is twice as fast as its default 6 and gives smaller files. */
constexpr int compression_level = 3;

/* Where libpng goes when something is wrong. */
struct PngState {
    std::jmp_buf jump;
    char text[128] = "";
    int error_number = 0;
};

void on_error(png_structp png, png_const_charp text) {
    PngState *state = static_cast<PngState *>(png_get_error_ptr(png));
    std::strncpy(state->text, text, sizeof state->text - 1);
    state->error_number = std::strcmp(text, "Write Error") == 0 ? errno : 0;
    std::longjmp(state->jump, 1);
}

/* What libpng warns about (odd profiles, unknown chunks) does not concern pixels; damage is an error here. */
void on_warning(png_structp, png_const_charp) {}

bool little_endian() {
    const uint16_t one = 1;
    uint8_t first;
    std::memcpy(&first, &one, 1);
    return first == 1;
}

/* libpng refuses to write the sRGB profile of 1998, which many cameras and editors embed, for faults in its tags. */
void keep_profile_as_it_is(png_structp png) {
    png_set_option(png, PNG_SKIP_sRGB_CHECK_PROFILE, PNG_OPTION_ON);
}

struct PngReader {
    explicit PngReader(const std::string &path) : file(open_for_reading(path)) {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &state, on_error, on_warning);
        info = png ? png_create_info_struct(png) : nullptr;
        if (!info)
            throw std::bad_alloc();
    }
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
    PngReader(const PngReader &) = delete;
    PngReader &operator=(const PngReader &) = delete;

    PngState state;
    File file;
    png_structp png = nullptr;
    png_infop info = nullptr;
    bool interlaced = false;
};

struct PngWriter {
    explicit PngWriter(const std::string &path) : file(open_for_writing(path)) {
        png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &state, on_error, on_warning);
        info = png ? png_create_info_struct(png) : nullptr;
        if (!info)
            throw std::bad_alloc();
    }
    ~PngWriter() { png_destroy_write_struct(&png, &info); }
    PngWriter(const PngWriter &) = delete;
    PngWriter &operator=(const PngWriter &) = delete;

    PngState state;
    File file;
    png_structp png = nullptr;
    png_infop info = nullptr;
};

void read_traits(PngReader &reader, Picture &picture) {
    PictureTraits &traits = picture.traits;
    traits.has_srgb = png_get_sRGB(reader.png, reader.info, &traits.srgb_intent) != 0;
    traits.has_gamma = png_get_gAMA_fixed(reader.png, reader.info, &traits.gamma) != 0;
    std::array<int32_t, 8> &c = traits.chromaticities;
    traits.has_chromaticities = png_get_cHRM_fixed(reader.png, reader.info, &c[0], &c[1], &c[2], &c[3], &c[4], &c[5],
                                                   &c[6], &c[7]) != 0;
    png_uint_32 x = 0, y = 0;
    int unit = 0;
    if (png_get_pHYs(reader.png, reader.info, &x, &y, &unit)) {
        traits.x_resolution = x;
        traits.y_resolution = y;
        traits.resolution_unit =
            unit == PNG_RESOLUTION_METER ? PictureTraits::Unit::metre : PictureTraits::Unit::none;
    }
    png_charp name = nullptr;
    int compression = 0;
    png_bytep profile = nullptr;
    png_uint_32 bytes = 0;
    if (png_get_iCCP(reader.png, reader.info, &name, &compression, &profile, &bytes))
        picture.icc.assign(profile, profile + bytes);
}

/* Everything before the pixels; sets libpng to deliver 8 or 16 bit samples in one of our layouts. */
void read_start(PngReader &reader, Picture &picture, const ReadRequest &request) {
    png_structp png = reader.png;
    png_set_user_limits(png, picture_max_side, picture_max_side);
    keep_profile_as_it_is(png);
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_init_io(png, reader.file.get());
    png_read_info(png, reader.info);
    read_traits(reader, picture);
    png_set_expand(png);
    if (little_endian())
        png_set_swap(png);
    reader.interlaced = png_set_interlace_handling(png) > 1;
    png_read_update_info(png, reader.info);
    picture.sample = png_get_bit_depth(png, reader.info) == 16 ? LENSPROF_SAMPLE_U16 : LENSPROF_SAMPLE_U8;
    picture.layout = png_get_channels(png, reader.info) - 1u; /* the layouts are in that order */
    set_frame(picture, png_get_image_width(png, reader.info), png_get_image_height(png, reader.info), request);
}

bool read_rows(PngReader &reader, const Picture &picture, RowSink &sink) {
    return guarded(reader.state.jump, [&] {
        for (uint32_t y = 0; y < picture.frame_height; ++y) {
            png_read_row(reader.png, sink.row(), nullptr);
            sink.accept();
        }
        png_read_end(reader.png, nullptr);
    });
}

/* An interlaced file has the whole frame seven times over, ever finer: it cannot be read row by row. */
bool read_interlaced(PngReader &reader, const Picture &picture, RowSink &sink) {
    const size_t row_bytes = static_cast<size_t>(pixel_bytes(picture) * picture.frame_width);
    std::vector<uint8_t> frame(row_bytes * picture.frame_height);
    std::vector<png_bytep> rows(picture.frame_height);
    for (size_t y = 0; y < rows.size(); ++y)
        rows[y] = frame.data() + y * row_bytes;
    const bool good = guarded(reader.state.jump, [&] {
        png_read_image(reader.png, rows.data());
        png_read_end(reader.png, nullptr);
    });
    for (size_t y = 0; good && y < rows.size(); ++y) {
        std::memcpy(sink.row(), rows[y], row_bytes);
        sink.accept();
    }
    return good;
}

void set_colour(const PngWriter &writer, const Picture &picture) {
    const PictureTraits &traits = picture.traits;
    const std::array<int32_t, 8> &c = traits.chromaticities;
    if (!picture.icc.empty()) /* a profile and an sRGB chunk exclude each other */
        png_set_iCCP(writer.png, writer.info, profile_name, PNG_COMPRESSION_TYPE_BASE, picture.icc.data(),
                     static_cast<png_uint_32>(picture.icc.size()));
    else if (traits.has_srgb)
        png_set_sRGB(writer.png, writer.info, traits.srgb_intent);
    if (traits.has_gamma)
        png_set_gAMA_fixed(writer.png, writer.info, traits.gamma);
    if (traits.has_chromaticities)
        png_set_cHRM_fixed(writer.png, writer.info, c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7]);
}

void set_resolution(const PngWriter &writer, const PictureTraits &traits) {
    using Unit = PictureTraits::Unit;
    if (!(traits.x_resolution > 0 && traits.y_resolution > 0))
        return;
    const double x = convert_resolution(traits.x_resolution, traits.resolution_unit, Unit::metre);
    const double y = convert_resolution(traits.y_resolution, traits.resolution_unit, Unit::metre);
    if (std::fmax(x, y) < 1e9)
        png_set_pHYs(writer.png, writer.info, static_cast<png_uint_32>(std::lround(x)),
                     static_cast<png_uint_32>(std::lround(y)),
                     traits.resolution_unit == Unit::none ? PNG_RESOLUTION_UNKNOWN : PNG_RESOLUTION_METER);
}

void write_all(const PngWriter &writer, const Picture &picture) {
    static const int colour_types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                       PNG_COLOR_TYPE_RGB_ALPHA};
    const bool deep = picture.sample == LENSPROF_SAMPLE_U16;
    png_set_user_limits(writer.png, picture_max_side, picture_max_side);
    keep_profile_as_it_is(writer.png);
    png_set_compression_level(writer.png, compression_level);
    png_init_io(writer.png, writer.file.get());
    png_set_IHDR(writer.png, writer.info, picture.width, picture.height, deep ? 16 : 8,
                 colour_types[picture.layout], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    set_colour(writer, picture);
    set_resolution(writer, picture.traits);
    png_write_info(writer.png, writer.info);
    if (deep && little_endian())
        png_set_swap(writer.png);
    for (uint32_t y = 0; y < picture.height; ++y)
        png_write_row(writer.png, picture.pixels.data() + y * picture.row_bytes);
    png_write_end(writer.png, writer.info);
}

}  // namespace

Picture read_png(const ReadRequest &request) {
    PngReader reader(request.path);
    Picture picture;
    picture.traits.format = FileFormat::png;
    if (!guarded(reader.state.jump, [&] { read_start(reader, picture, request); }))
        fail_damaged(request.path, reader.state.text);
    if (request.header_only)
        return picture;
    RowSink sink(picture, picture.frame_width);
    const bool good = reader.interlaced ? read_interlaced(reader, picture, sink) : read_rows(reader, picture, sink);
    if (!good)
        fail_damaged(request.path, reader.state.text);
    return picture;
}

void write_png(const std::string &path, const Picture &picture) {
    const bool alpha = picture.layout == LENSPROF_LAYOUT_GREY_ALPHA || picture.layout == LENSPROF_LAYOUT_RGBA;
    if (picture.sample == LENSPROF_SAMPLE_F32)
        fail_to_hold(path, "PNG holds 8 or 16 bit samples, not float; write a .tif file");
    if (alpha && picture.traits.alpha == PictureTraits::Alpha::associated)
        fail_to_hold(path, "PNG does not hold colour premultiplied with alpha; write a .tif file");
    PngWriter writer(path);
    if (!guarded(writer.state.jump, [&] { write_all(writer, picture); }))
        fail_to_write(path, writer.state.text, writer.state.error_number);
    close_written(writer.file, path);
}

}  // namespace codec

}  // namespace lensprof
