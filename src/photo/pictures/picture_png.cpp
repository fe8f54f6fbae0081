// PNG through libpng. Its errors leave by longjmp: see codec::guarded.
#include "photo/pictures/codec.hpp"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

#include <png.h>

#include "photo/base/events.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr char profile_name[] = "ICC profile";

// For photographs zlib's level 3 is twice as fast as its default 6 and gives smaller files.
constexpr int compression_level = 3;

// Error handling of libpng.
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

// Warnings of libpng (odd profiles, unknown chunks) do not concern pixels; damage is an error here.
void on_warning(png_structp, png_const_charp) {}

bool little_endian() {
    const uint16_t probe = 1;
    uint8_t first;
    std::memcpy(&first, &probe, 1);
    return first == 1;
}

// libpng refuses to write the sRGB profile of 1998, which many cameras and editors embed, because of faults in its
// tags.
void keep_profile_as_it_is(png_structp png) { png_set_option(png, PNG_SKIP_sRGB_CHECK_PROFILE, PNG_OPTION_ON); }

struct PngReader {
    explicit PngReader(const std::string &path) : file(open_for_reading(path)) {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &state, on_error, on_warning);
        info = png ? png_create_info_struct(png) : nullptr;
        if (!info) throw std::bad_alloc();
    }
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
    PngReader(const PngReader &) = delete;
    PngReader &operator=(const PngReader &) = delete;

    PngState state;
    File file;
    png_structp png = nullptr;
    png_infop info = nullptr;
    int passes = 1;  // 7 when interlaced
};

struct PngWriter {
    explicit PngWriter(const std::string &path) : file(open_for_writing(path)) {
        png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &state, on_error, on_warning);
        info = png ? png_create_info_struct(png) : nullptr;
        if (!info) throw std::bad_alloc();
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
    traits.has_chromaticities =
        png_get_cHRM_fixed(reader.png, reader.info, &c[0], &c[1], &c[2], &c[3], &c[4], &c[5], &c[6], &c[7]) != 0;
    png_uint_32 x = 0, y = 0;
    int unit = 0;
    if (png_get_pHYs(reader.png, reader.info, &x, &y, &unit)) {
        traits.x_resolution = x;
        traits.y_resolution = y;
        traits.resolution_unit = unit == PNG_RESOLUTION_METER ? PictureTraits::Unit::metre : PictureTraits::Unit::none;
    }
    png_charp name = nullptr;
    int compression = 0;
    png_bytep profile = nullptr;
    png_uint_32 bytes = 0;
    if (png_get_iCCP(reader.png, reader.info, &name, &compression, &profile, &bytes))
        picture.icc.assign(profile, profile + bytes);
}

// Bytes of the samples as the file packs them.
uint64_t packed_bytes(const PngReader &reader) {
    const uint64_t bits =
        uint64_t(png_get_channels(reader.png, reader.info)) * png_get_bit_depth(reader.png, reader.info);
    return uint64_t(png_get_image_width(reader.png, reader.info)) * png_get_image_height(reader.png, reader.info) * bits
           / 8;
}

// Reads everything before the pixels; sets libpng to return 8 or 16 bit samples in one of our layouts.
void read_start(PngReader &reader, Picture &picture, const ReadRequest &request) {
    png_structp png = reader.png;
    png_set_user_limits(png, picture_max_side, picture_max_side);
    keep_profile_as_it_is(png);
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_init_io(png, reader.file.get());
    png_read_info(png, reader.info);
    read_traits(reader, picture);
    const uint64_t packed = packed_bytes(reader);
    png_set_expand(png);
    if (little_endian()) png_set_swap(png);
    reader.passes = png_set_interlace_handling(png);
    png_read_update_info(png, reader.info);
    picture.sample = png_get_bit_depth(png, reader.info) == 16 ? LENSPROF_SAMPLE_U16 : LENSPROF_SAMPLE_U8;
    picture.layout = png_get_channels(png, reader.info) - 1u;  // the layouts are in that order
    set_frame(picture, png_get_image_width(png, reader.info), png_get_image_height(png, reader.info), request);
    check_stored(request.path, size_text(picture.frame_width, picture.frame_height), packed,
                 file_bytes(reader.file.get()), deflate_expansion);
}

class PngSource final : public RowSource {
public:
    explicit PngSource(const ReadRequest &request);
    void read(uint8_t *row) override;
    void finish() override;

private:
    void read_interlaced();
    size_t frame_row_bytes() const { return static_cast<size_t>(pixel_bytes(header_) * header_.frame_width); }
    void check(bool good) const;

    std::string path_;
    PngReader reader_;
    LazyBytes frame_{nullptr, std::free};  // of an interlaced file
    uint32_t next_ = 0;
};

PngSource::PngSource(const ReadRequest &request) : path_(request.path), reader_(request.path) {
    header_.traits.format = FileFormat::png;
    check(guarded(reader_.state.jump, [&] { read_start(reader_, header_, request); }));
}

void PngSource::check(bool good) const {
    if (!good) fail_damaged(path_, reader_.state.text);
}

void PngSource::read(uint8_t *row) {
    if (reader_.passes == 1) {
        check(guarded(reader_.state.jump, [&] { png_read_row(reader_.png, row, nullptr); }));
        return;
    }
    if (next_ == 0) read_interlaced();
    std::memcpy(row, frame_.get() + next_++ * frame_row_bytes(), frame_row_bytes());
}

// An interlaced file stores the whole frame seven times, increasingly fine: it cannot be read row by row.
void PngSource::read_interlaced() {
    const size_t row_bytes = frame_row_bytes();
    frame_ = make_lazy_bytes(row_bytes * header_.frame_height);
    for (int pass = 0; pass < reader_.passes; ++pass) {
        stop_if_cancelled();
        check(guarded(reader_.state.jump, [&] {
            for (uint32_t y = 0; y < header_.frame_height; ++y)
                png_read_row(reader_.png, frame_.get() + y * row_bytes, nullptr);
        }));
    }
}

void PngSource::finish() {
    check(guarded(reader_.state.jump, [&] { png_read_end(reader_.png, nullptr); }));
}

void set_colour(const PngWriter &writer, const Picture &picture) {
    const PictureTraits &traits = picture.traits;
    const std::array<int32_t, 8> &c = traits.chromaticities;
    if (!picture.icc.empty())  // a profile and an sRGB chunk exclude each other
        png_set_iCCP(writer.png, writer.info, profile_name, PNG_COMPRESSION_TYPE_BASE, picture.icc.data(),
                     static_cast<png_uint_32>(picture.icc.size()));
    else if (traits.has_srgb)
        png_set_sRGB(writer.png, writer.info, traits.srgb_intent);
    if (traits.has_gamma) png_set_gAMA_fixed(writer.png, writer.info, traits.gamma);
    if (traits.has_chromaticities)
        png_set_cHRM_fixed(writer.png, writer.info, c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7]);
}

void set_resolution(const PngWriter &writer, const PictureTraits &traits) {
    using Unit = PictureTraits::Unit;
    if (!(traits.x_resolution > 0 && traits.y_resolution > 0)) return;
    const double x = convert_resolution(traits.x_resolution, traits.resolution_unit, Unit::metre);
    const double y = convert_resolution(traits.y_resolution, traits.resolution_unit, Unit::metre);
    if (std::fmax(x, y) < 1e9)
        png_set_pHYs(writer.png, writer.info, static_cast<png_uint_32>(std::lround(x)),
                     static_cast<png_uint_32>(std::lround(y)),
                     traits.resolution_unit == Unit::none ? PNG_RESOLUTION_UNKNOWN : PNG_RESOLUTION_METER);
}

// Writes everything before the pixels.
void write_start(const PngWriter &writer, const Picture &picture) {
    static const int colour_types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                       PNG_COLOR_TYPE_RGB_ALPHA};
    const bool deep = picture.sample == LENSPROF_SAMPLE_U16;
    png_set_user_limits(writer.png, picture_max_side, picture_max_side);
    keep_profile_as_it_is(writer.png);
    png_set_compression_level(writer.png, compression_level);
    png_init_io(writer.png, writer.file.get());
    png_set_IHDR(writer.png, writer.info, picture.width, picture.height, deep ? 16 : 8, colour_types[picture.layout],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    set_colour(writer, picture);
    set_resolution(writer, picture.traits);
    png_write_info(writer.png, writer.info);
    if (deep && little_endian()) png_set_swap(writer.png);
}

class PngSink final : public RowSink {
public:
    PngSink(const std::string &path, const Picture &header) : path_(path), writer_(path) {
        check(guarded(writer_.state.jump, [&] { write_start(writer_, header); }));
    }

    void write(const uint8_t *row) override {
        check(guarded(writer_.state.jump, [&] { png_write_row(writer_.png, row); }));
    }

    void finish() override {
        check(guarded(writer_.state.jump, [&] { png_write_end(writer_.png, writer_.info); }));
        close_written(writer_.file, path_);
    }

private:
    void check(bool good) const {
        if (!good) fail_to_write(path_, writer_.state.text, writer_.state.error_number);
    }

    std::string path_;
    PngWriter writer_;
};

}  // namespace

std::unique_ptr<RowSource> open_png(const ReadRequest &request) { return std::make_unique<PngSource>(request); }

std::unique_ptr<RowSink> create_png(const std::string &path, const Picture &header) {
    const bool alpha = header.layout == LENSPROF_LAYOUT_GREY_ALPHA || header.layout == LENSPROF_LAYOUT_RGBA;
    if (header.sample == LENSPROF_SAMPLE_F32)
        fail_to_hold(path, "PNG holds 8 or 16 bit samples, not float; write a .tif file");
    if (alpha && header.traits.alpha == PictureTraits::Alpha::associated)
        fail_to_hold(path, "PNG does not hold colour premultiplied with alpha; write a .tif file");
    return std::make_unique<PngSink>(path, header);
}

}  // namespace codec

}  // namespace lensprof
