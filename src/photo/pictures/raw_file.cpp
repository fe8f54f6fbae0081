#include "photo/pictures/raw_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <new>

#include <libraw/libraw.h>

#include "photo/base/events.hpp"
#include "photo/pictures/codec.hpp"
#include "photo/pictures/raw_blocks.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr unsigned max_memory_mb = 2048;
constexpr uint64_t max_expansion = 1024;  // maximum pixels per byte of a file: Deflate of two bytes each
constexpr uint32_t colour_period = 12;    // columns after which mosaics repeat: 2 (Bayer) and 6 (X-Trans)
constexpr uint16_t saturated = 65535;

// Detects reads beyond the end, which LibRaw's bit readers answer with zeros, and how much of each block is read.
class CheckedStream final : public LibRaw_bigfile_datastream {
public:
    explicit CheckedStream(const std::string &path) : LibRaw_bigfile_datastream(path.c_str()) {}
    int read(void *to, size_t size, size_t count) override {
        const int received = LibRaw_bigfile_datastream::read(to, size, count);
        if (received <= 0 && size * count > 0) is_past_end = true;
        if (received < static_cast<int>(count)) is_short = true;
        return received;
    }
    int get_char() override {
        const int c = LibRaw_bigfile_datastream::get_char();
        if (c < 0) is_past_end = true;
        return c;
    }
    int seek(INT64 offset, int whence) override {
        leave_block();
        if (before_seek) before_seek();
        const int status = LibRaw_bigfile_datastream::seek(offset, whence);
        block_ = blocks.find(static_cast<uint64_t>(tell()));
        return status;
    }

    // Ends the current block. A block of which less than half was needed is damaged.
    void leave_block() {
        if (block_ != blocks.end() && (static_cast<uint64_t>(tell()) - block_->first) * 2 < block_->second)
            is_stopped_early = true;
        block_ = blocks.end();
    }

    RawBlocks blocks;
    std::function<void()> before_seek;
    bool is_stopped_early = false;
    bool is_past_end = false;
    bool is_short = false;  // a block was incomplete; some decoders request more than they need

private:
    RawBlocks::const_iterator block_ = blocks.end();
};

int on_progress(void *, LibRaw_progress, int, int) { return is_cancelled() ? 1 : 0; }

void on_memory_error(void *, const char *, const char *) {}
void on_data_error(void *, const char *, int) {}  // error_count() reports errors; LibRaw's own handler prints

// Converts an error of LibRaw to a Failure.
[[noreturn]] void fail_libraw(int status, const std::string &path, const std::string &kind) {
    stop_if_cancelled();
    switch (status) {
    case LIBRAW_UNSUFFICIENT_MEMORY: fail_memory(path);
    case LIBRAW_TOO_BIG:
    case LIBRAW_MEMPOOL_OVERFLOW:
        fail_unsupported(path, "camera raw file (" + kind + ") that declares more than " + std::to_string(max_memory_mb)
                                   + " MB of pixels; copy it again, or develop it to a linear 16 bit TIFF");
    case LIBRAW_FILE_UNSUPPORTED:
    case LIBRAW_NOT_IMPLEMENTED:
        fail_unsupported(path, "camera raw file (" + kind + ") that LibRaw " + LibRaw::version()
                                   + " cannot read, or a damaged one; copy it again, convert it to DNG, or develop it "
                                     "to a linear 16 bit TIFF");
    default: fail_damaged(path, "camera raw file, " + kind + ": " + LibRaw::strerror(status));
    }
}

}  // namespace

struct RawFile::Decoder {
    explicit Decoder(const std::string &path) : stream(path), libraw(LIBRAW_OPTIONS_NONE) {
        libraw.set_progress_handler(on_progress, nullptr);
        libraw.set_dataerror_handler(on_data_error, nullptr);
        libraw.set_memerror_handler(on_memory_error, nullptr);
        libraw_output_params_t &o = libraw.imgdata.params;
#if LIBRAW_COMPILE_CHECK_VERSION_NOTLESS(0, 21)
        libraw.imgdata.rawparams.max_raw_memory_mb = max_memory_mb;
#else
        o.max_raw_memory_mb = max_memory_mb;
#endif
        o.output_color = 0;   // the camera's own
        o.no_auto_scale = 1;  // values are linear by then
        o.no_auto_bright = 1;
        o.user_flip = 0;
        o.use_fuji_rotate = 0;
        o.output_bps = 16;
        o.adjust_maximum_thr = 0;
        o.user_qual = 3;
    }

    libraw_data_t &data() { return libraw.imgdata; }

    CheckedStream stream;
    LibRaw libraw;
};

RawFile::RawFile(const std::string &path, const std::string &kind) : path_(path), kind_(kind) {
    open_for_reading(path);  // for its errors
    decoder_ = std::make_unique<Decoder>(path);
    check(decoder_->libraw.open_datastream(&decoder_->stream));
    check_size();
    check_kind();
}

RawFile::~RawFile() = default;

void RawFile::check(int status) const {
    if (status != LIBRAW_SUCCESS) fail_libraw(status, path_, kind_);
}

// Before memory is allocated for the declared size.
void RawFile::check_size() const {
    const libraw_image_sizes_t &s = decoder_->data().sizes;
    const uint64_t pixels = uint64_t(s.raw_width) * s.raw_height;
    check_stored(path_, size_text(s.raw_width, s.raw_height), pixels,
                 static_cast<uint64_t>(std::max<INT64>(decoder_->stream.size(), 0)), max_expansion);
    if (s.width == 0 || s.height == 0) fail_damaged(path_, size_text(s.width, s.height));
}

// Refuses kinds other than one linear value per channel on a square grid.
void RawFile::check_kind() const {
    LibRaw &libraw = decoder_->libraw;
    const libraw_data_t &d = libraw.imgdata;
    const auto refuse = [&](const std::string &message) {
        fail_unsupported(path_, "camera raw file (" + kind_ + ") of " + message
                                    + ", which lensprof does not read; develop it to a linear 16 bit TIFF first");
    };
    if (d.idata.is_foveon) refuse("a Foveon sensor");
    if (libraw.is_fuji_rotated()) refuse("a sensor whose grid is rotated by 45 degrees (Super CCD)");
    if (libraw.is_sraw() || libraw.is_nikon_sraw())
        refuse("reduced size (sRAW), whose values the camera has processed");
    if (libraw.is_floating_point()) refuse("floating point values (a merged HDR)");
    if (d.idata.colors != 3 && d.idata.colors != 1) refuse(std::to_string(d.idata.colors) + " colours");
    if (d.idata.filters == 1) refuse("a mosaic of 16 x 16 pixels (Leaf)");
    if (std::strcmp(d.idata.cdesc, "RGBG") != 0 && d.idata.colors == 3)
        refuse("the colours " + std::string(d.idata.cdesc));
    if (d.color.phase_one_data.format) refuse("Phase One's compression");
}

uint32_t RawFile::width() const { return decoder_->data().sizes.width; }
uint32_t RawFile::height() const { return decoder_->data().sizes.height; }
bool RawFile::is_mosaic() const { return decoder_->data().idata.filters != 0; }
uint32_t RawFile::channels() const { return decoder_->data().idata.colors == 1 ? 1 : 3; }

uint32_t RawFile::orientation() const {
    switch (decoder_->data().sizes.flip) {
    case 3: return 3;
    case 5: return 8;
    case 6: return 6;
    default: return 1;
    }
}

// LibRaw allocates the pixels, seeks to them in the file and decodes them. If a decoder gives up it may report nothing:
// unwritten pixels are then black, not uninitialised.
void RawFile::decode() {
    CheckedStream &stream = decoder_->stream;
    libraw_data_t &d = decoder_->data();
    stream.blocks = check_raw_blocks(path_, d.sizes.raw_width, d.sizes.raw_height);
    stream.is_past_end = stream.is_stopped_early = false;
    bool is_clear = false;
    stream.before_seek = [&] {
        if (is_clear || !d.rawdata.raw_alloc) return;
        std::memset(d.rawdata.raw_alloc, 0, size_t(d.sizes.raw_pitch) * d.sizes.raw_height);
        is_clear = true;
    };
    const int status = decoder_->libraw.unpack();
    stream.before_seek = nullptr;
    stream.leave_block();
    check(status);
}

void RawFile::unpack() {
    const uint32_t declared_width = width(), declared_height = height();
    decode();
    const bool is_cut = decoder_->data().idata.dng_version != 0 && decoder_->stream.is_past_end;
    if (is_cut || decoder_->libraw.error_count() > 0) fail_damaged(path_, "its pixels are cut off");
    if (decoder_->stream.is_stopped_early) fail_damaged(path_, "its pixels use less than half of the stored bytes");
    if (width() != declared_width || height() != declared_height)
        fail_damaged(path_, size_text(width(), height()) + " instead of the declared "
                                + size_text(declared_width, declared_height));
    make_linear();
}

void RawFile::make_linear() {
    const libraw_rawdata_t &raw = decoder_->data().rawdata;
    if (raw.raw_image)
        make_linear_mosaic();
    else if (raw.color3_image || raw.color4_image)
        make_linear_pixels();
    else
        fail_unsupported(path_, "camera raw file (" + kind_ + ") whose pixels LibRaw does not return as integers; "
                                                              "develop it to a linear 16 bit TIFF first");
}

namespace {

// Black and white level of a channel at a position.
struct Level {
    float black, scale;  // scale: 65535 over white - black
    float white;         // saturated from here on
    uint16_t normalised(uint16_t v) const {
        if (v >= white) return saturated;
        return static_cast<uint16_t>(std::clamp((v - black) * scale + 0.5f, 0.0f, 65534.0f));
    }
};

// Saturation is as stated by the file, below the nominal white for many cameras.
float saturation_of(const libraw_colordata_t &c, uint32_t channel, float white) {
    const auto stated = static_cast<float>(c.linear_max[channel & 3]);
    return stated > 0.6f * white && stated < white ? stated : white;
}

}  // namespace

// A black level is the sum of a common one, one per channel and one per position of a repeating pattern.
void RawFile::make_linear_mosaic() {
    libraw_data_t &d = decoder_->data();
    const libraw_colordata_t &c = d.color;
    const uint32_t rows = c.cblack[4], columns = c.cblack[5], wide = width();
    const bool has_pattern = rows > 0 && columns > 0 && uint64_t(rows) * columns <= LIBRAW_CBLACK_SIZE - 6;
    const auto white = static_cast<float>(c.maximum);
    for (uint32_t y = 0; y < height(); ++y) {
        if (y % 64 == 0) stop_if_cancelled();
        std::array<uint32_t, colour_period> colour{};
        for (uint32_t x = 0; x < colour_period && is_mosaic(); ++x)
            colour[x] = static_cast<uint32_t>(decoder_->libraw.COLOR(static_cast<int>(y), static_cast<int>(x))) & 3;
        uint16_t *row =
            d.rawdata.raw_image + size_t(y + d.sizes.top_margin) * (d.sizes.raw_pitch / 2) + d.sizes.left_margin;
        for (uint32_t x = 0, column = 0; x < wide; ++x, column = column + 1 == columns ? 0 : column + 1) {
            const uint32_t channel = colour[x % colour_period];
            uint64_t black = uint64_t(c.black) + c.cblack[channel];
            if (has_pattern) black += c.cblack[6 + y % rows * columns + column];
            const auto b = static_cast<float>(black);
            if (!(white > b)) fail_damaged(path_, "its black level is not below its white level");
            row[x] = Level{b, 65535.0f / (white - b), saturation_of(c, channel, white)}.normalised(row[x]);
        }
    }
}

// Linear raw: every pixel has all channels.
void RawFile::make_linear_pixels() {
    libraw_data_t &d = decoder_->data();
    const libraw_colordata_t &c = d.color;
    const size_t step = d.rawdata.color3_image ? 3 : 4;
    auto *samples = d.rawdata.color3_image ? reinterpret_cast<uint16_t *>(d.rawdata.color3_image)
                                           : reinterpret_cast<uint16_t *>(d.rawdata.color4_image);
    std::array<Level, 3> levels{};
    for (uint32_t i = 0; i < 3; ++i) {
        const unsigned dng_white = d.idata.dng_version ? c.dng_levels.dng_whitelevel[i] : 0;
        const auto white = static_cast<float>(dng_white ? dng_white : c.maximum),
                   black = static_cast<float>(c.black + c.cblack[i]);
        if (!(white > black)) fail_damaged(path_, "its black level is not below its white level");
        levels[i] = {black, 65535.0f / (white - black), white};
    }
    for (uint32_t y = 0; y < height(); ++y) {
        if (y % 64 == 0) stop_if_cancelled();
        uint16_t *row =
            samples + size_t(y + d.sizes.top_margin) * (d.sizes.raw_pitch / 2) + size_t(d.sizes.left_margin) * step;
        for (uint32_t x = 0; x < width(); ++x)
            for (uint32_t i = 0; i < channels(); ++i) row[x * step + i] = levels[i].normalised(row[x * step + i]);
    }
}

uint32_t RawFile::channel_at(int x, int y) const {
    const int colour = decoder_->libraw.COLOR(y, x);
    return colour == 3 ? 1 : static_cast<uint32_t>(colour);  // the second green
}

uint16_t RawFile::mean_of(int x0, int y0, int side, uint32_t channel) const {
    const libraw_data_t &d = decoder_->data();
    const size_t pitch = d.sizes.raw_pitch / 2;
    const uint16_t *origin = d.rawdata.raw_image + d.sizes.top_margin * pitch + d.sizes.left_margin;
    uint32_t sum = 0, count = 0;
    for (int y = std::max(y0, 0); y < std::min(y0 + side, static_cast<int>(height())); ++y)
        for (int x = std::max(x0, 0); x < std::min(x0 + side, static_cast<int>(width())); ++x) {
            if (channel_at(x, y) != channel) continue;
            const uint16_t value = origin[size_t(y) * pitch + size_t(x)];
            if (value == saturated) return saturated;
            sum += value;
            ++count;
        }
    return count ? static_cast<uint16_t>((sum + count / 2) / count) : saturated;  // none: not known
}

void RawFile::halved_row(uint32_t y, uint16_t *rgb) const {
    const int top = static_cast<int>(2 * y), wide = static_cast<int>(width());
    for (int x = 0; x < wide / 2; ++x)
        for (uint32_t c = 0; c < 3; ++c) {
            bool has = false;
            for (int i = 0; i < 4; ++i) has |= channel_at(2 * x + i % 2, top + i / 2) == c;
            *rgb++ = has ? mean_of(2 * x, top, 2, c) : mean_of(2 * x - 1, top - 1, 4, c);
        }
}

// LibRaw copies what unpack() stored; black and white are by now those of the linear values.
void RawFile::demosaic() {
    if (!is_mosaic()) return;
    libraw_data_t &d = decoder_->data();
    for (libraw_colordata_t *c : {&d.color, &d.rawdata.color}) {
        std::memset(c->cblack, 0, sizeof c->cblack);
        c->black = 0;
        c->maximum = c->data_maximum = saturated;
    }
    check(decoder_->libraw.dcraw_process());
    if (d.sizes.width != d.sizes.iwidth || d.sizes.height != d.sizes.iheight || !d.image)
        fail_damaged(path_, "LibRaw decodes a size other than the declared one");
}

void RawFile::full_row(uint32_t y, uint16_t *samples) const {
    const libraw_data_t &d = decoder_->data();
    const size_t pitch = d.sizes.raw_pitch / 2;
    const size_t first = size_t(y + d.sizes.top_margin) * pitch;
    if (is_mosaic()) {
        const uint16_t *raw_row = d.rawdata.raw_image + first + d.sizes.left_margin;
        for (uint32_t x = 0; x < width(); ++x, samples += 3) {
            const uint32_t channel = channel_at(static_cast<int>(x), static_cast<int>(y));
            for (uint32_t c = 0; c < 3; ++c) {
                samples[c] = d.image[size_t(y) * width() + x][c];
                if (samples[c] == 0 && c != channel)  // in a corner of X-Trans LibRaw may find no neighbour
                    samples[c] = mean_of(static_cast<int>(x) - 2, static_cast<int>(y) - 2, 5, c);
            }
            samples[channel] = raw_row[x];
        }
        return;
    }
    const uint32_t count = channels();
    const size_t step = d.rawdata.raw_image ? 1 : d.rawdata.color3_image ? 3 : 4;
    const uint16_t *row = d.rawdata.raw_image      ? d.rawdata.raw_image
                          : d.rawdata.color3_image ? reinterpret_cast<uint16_t *>(d.rawdata.color3_image)
                                                   : reinterpret_cast<uint16_t *>(d.rawdata.color4_image);
    row += first + d.sizes.left_margin * step;
    for (uint32_t x = 0; x < width(); ++x)
        for (uint32_t c = 0; c < count; ++c) *samples++ = row[x * step + c];
}

RawColour RawFile::colour() const {
    const libraw_data_t &d = decoder_->data();
    RawColour colour;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) colour.xyz_to_camera[i][k] = d.color.cam_xyz[i][k];
    const float *mul = d.color.cam_mul[0] > 0 && d.color.cam_mul[2] > 0 ? d.color.cam_mul : d.color.pre_mul;
    float neutral[3], largest = 0;
    for (int i = 0; i < 3; ++i) largest = std::max(largest, neutral[i] = mul[i] > 0 ? 1 / mul[i] : 1);
    for (int i = 0; i < 3; ++i) colour.as_shot_neutral[i] = neutral[i] / largest;
    colour.model = std::string(d.idata.make) + " " + d.idata.model;
    return colour;
}

std::vector<uint8_t> raw_preview_bytes(const std::string &path, const std::string &kind) {
    open_for_reading(path);
    CheckedStream stream(path);
    auto libraw = std::make_unique<LibRaw>(LIBRAW_OPTIONS_NONE);
    libraw->set_dataerror_handler(on_data_error, nullptr);
    libraw->set_memerror_handler(on_memory_error, nullptr);
    int status = libraw->open_datastream(&stream);
    stream.is_short = false;
    if (status == LIBRAW_SUCCESS) status = libraw->unpack_thumb();
    if (status == LIBRAW_SUCCESS && stream.is_short) fail_damaged(path, "its preview is cut off");
    const libraw_thumbnail_t &thumbnail = libraw->imgdata.thumbnail;
    if (status == LIBRAW_NO_THUMBNAIL || status == LIBRAW_UNSUPPORTED_THUMBNAIL
        || (status == LIBRAW_SUCCESS && (thumbnail.tformat != LIBRAW_THUMBNAIL_JPEG || !thumbnail.thumb)))
        fail_unsupported(path, "camera raw file (" + kind + ") without a JPEG preview; use a JPEG of the same picture");
    if (status != LIBRAW_SUCCESS) fail_libraw(status, path, kind);
    const auto *bytes = reinterpret_cast<const uint8_t *>(thumbnail.thumb);
    return {bytes, bytes + thumbnail.tlength};
}

}  // namespace codec

}  // namespace lensprof
