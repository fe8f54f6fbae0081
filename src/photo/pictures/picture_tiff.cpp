// TIFF through libtiff.
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "photo/pictures/picture_stack.hpp"
#include "photo/pictures/tiff_handle.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

namespace codec {

namespace {

// A larger tile or strip means a damaged header.
constexpr uint64_t block_max_bytes = uint64_t(1) << 30;

// Classic TIFF has 32 bit offsets; the rest of 4 GiB is for directory and metadata.
constexpr uint64_t classic_max_bytes = uint64_t(4000) << 20;

// Bytes of a strip before compression.
constexpr size_t strip_bytes = size_t(256) << 10;

// Limits of a strip or tile by compression.
struct Limits {
    uint64_t expansion;           // maximum expansion per byte; 0 = unlimited, because a uniform block has a few bytes
    uint64_t least_bytes = 0;     // of a block
    uint32_t most_side = 0;       // of a block, in pixels; 0 = any
    bool decodes_blocks = false;  // needs a whole block in memory, even if rows are read
};

// Empty for compressions that no supported picture can have: those of one, two or four bits per sample and of other
// colours.
std::optional<Limits> limits_of(uint16_t compression) {
    constexpr uint64_t jpeg = 1366;  // a bit for 8 x 8 samples, 18 such blocks for 32 x 32 pixels of three
    switch (compression) {
    case COMPRESSION_NONE: return Limits{1};
    case COMPRESSION_PACKBITS:
        return Limits{64};  // 128 of two
    // A string is no longer than the table of 4096, its code then has 12 bits.
    case COMPRESSION_LZW: return Limits{2731};
    case COMPRESSION_ADOBE_DEFLATE:
    case COMPRESSION_DEFLATE: return Limits{deflate_expansion};
    case COMPRESSION_PIXARLOG: return Limits{2 * deflate_expansion};  // floats of 16 bit codes
    case COMPRESSION_JPEG:
    case COMPRESSION_OJPEG: return Limits{jpeg};
    case COMPRESSION_LZMA: return Limits{8192};  // 273 of 14 binary decisions of 0.022 bits each
    case COMPRESSION_ZSTD:
        return Limits{32768};  // a block of 128 KiB of 4
    // The headers of the file and of its only chunk; 14 bits of each side.
    case COMPRESSION_WEBP: return Limits{0, 20, 16383, true};
    case COMPRESSION_LERC: return Limits{0, 1, 0, true};  // its header, perhaps deflated
    default: return std::nullopt;
    }
}

// Refuses a picture that its strips or tiles cannot contain. Their own sizes count, not that of the file: they may
// share data.
void check_stored_frame(const Tiff &tiff, const std::string &path, const Picture &picture, const Limits &limits) {
    const uint64_t needed = pixel_bytes(picture) * picture.frame_width * picture.frame_height;
    const uint32_t blocks = TIFFIsTiled(tiff.handle) ? TIFFNumberOfTiles(tiff.handle) : TIFFNumberOfStrips(tiff.handle);
    const std::string declared = size_text(picture.frame_width, picture.frame_height);
    uint64_t stored = 0;
    for (uint32_t i = 0; i < blocks && stored < needed; ++i) {
        if (tiff.stored(i) < limits.least_bytes) check_stored(path, declared, needed, tiff.stored(i), 1);
        stored += tiff.stored(i);
    }
    check_stored(path, declared, needed, stored, limits.expansion, tiff.file_bytes());
}

[[noreturn]] void fail_kind(const ReadRequest &request, const std::string &kind) {
    fail_unsupported(request.path, kind + "; convert it to 8 or 16 bit or float, grey or RGB, first");
}

void check_not_raw(const Tiff &tiff, const ReadRequest &request) {
    const uint8_t *version = nullptr;
    if (TIFFGetField(tiff.handle, TIFFTAG_DNGVERSION, &version)
        || (tiff.field<uint32_t>(TIFFTAG_SUBFILETYPE, 0) & FILETYPE_REDUCEDIMAGE))
        fail_unsupported(request.path, "camera raw file, or its first page is a preview; develop it to TIFF first");
}

void read_sample(const Tiff &tiff, const ReadRequest &request, Picture &picture) {
    const unsigned bits = tiff.field<uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
    const unsigned format = tiff.field<uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    const bool integer = format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID;
    if (integer && bits == 8)
        picture.sample = LENSPROF_SAMPLE_U8;
    else if (integer && bits == 16)
        picture.sample = LENSPROF_SAMPLE_U16;
    else if (format == SAMPLEFORMAT_IEEEFP && bits == 32)
        picture.sample = LENSPROF_SAMPLE_F32;
    else
        fail_kind(request, std::to_string(bits) + " bit TIFF of sample format " + std::to_string(format));
}

void read_layout(const Tiff &tiff, const ReadRequest &request, Picture &picture) {
    const unsigned samples = tiff.field<uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    uint16_t photometric = 0;
    if (!TIFFGetField(tiff.handle, TIFFTAG_PHOTOMETRIC, &photometric))
        fail_kind(request, "TIFF that does not declare the meaning of its samples");
    const bool jpeg = tiff.field<uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_JPEG;
    if (photometric == PHOTOMETRIC_YCBCR && jpeg) TIFFSetField(tiff.handle, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    const bool grey = photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE;
    if (!grey && photometric != PHOTOMETRIC_RGB && !(photometric == PHOTOMETRIC_YCBCR && jpeg))
        fail_kind(request, "TIFF of photometric interpretation " + std::to_string(photometric));
    const unsigned colours = grey ? 1 : 3;
    if (samples != colours && samples != colours + 1)
        fail_kind(request, "TIFF with " + std::to_string(samples) + " samples per pixel");
    picture.layout = samples - 1;  // the layouts are in that order

    uint16_t extras = 0;
    const uint16_t *kinds = nullptr;
    TIFFGetFieldDefaulted(tiff.handle, TIFFTAG_EXTRASAMPLES, &extras, &kinds);
    const unsigned kind = extras > 0 ? kinds[0] : EXTRASAMPLE_UNSPECIFIED;
    picture.traits.alpha = kind == EXTRASAMPLE_ASSOCALPHA   ? PictureTraits::Alpha::associated
                           : kind == EXTRASAMPLE_UNASSALPHA ? PictureTraits::Alpha::unassociated
                                                            : PictureTraits::Alpha::unspecified;
}

void read_traits(const Tiff &tiff, Picture &picture) {
    using Unit = PictureTraits::Unit;
    PictureTraits &traits = picture.traits;
    traits.format = FileFormat::tiff;
    traits.compression = tiff.field<uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    traits.orientation = tiff.field<uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    traits.x_resolution = tiff.field<float>(TIFFTAG_XRESOLUTION, 0);
    traits.y_resolution = tiff.field<float>(TIFFTAG_YRESOLUTION, 0);
    const unsigned unit = tiff.field<uint16_t>(TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
    traits.resolution_unit = unit == RESUNIT_INCH         ? Unit::inch
                             : unit == RESUNIT_CENTIMETER ? Unit::centimetre
                                                          : Unit::none;
    uint32_t bytes = 0;
    const uint8_t *profile = nullptr;
    if (TIFFGetField(tiff.handle, TIFFTAG_ICCPROFILE, &bytes, &profile)) picture.icc.assign(profile, profile + bytes);
}

// Inverts a row of a min-is-white file, except its extra sample.
void invert_row(const Picture &picture, uint8_t *row) {
    const size_t samples = lensprof_layout_samples(picture.layout);
    for (size_t i = 0; i < picture.frame_width * samples; i += samples) {
        if (picture.sample == LENSPROF_SAMPLE_U8)
            row[i] = static_cast<uint8_t>(255 - row[i]);
        else if (picture.sample == LENSPROF_SAMPLE_U16)
            reinterpret_cast<uint16_t *>(row)[i] = static_cast<uint16_t>(65535 - reinterpret_cast<uint16_t *>(row)[i]);
        else
            reinterpret_cast<float *>(row)[i] = 1.0f - reinterpret_cast<float *>(row)[i];
    }
}

// Reads the frame in bands of whole rows: one row of a stripped file with interleaved samples, else one row of tiles
// or the strips of all planes.
class BandReader {
public:
    BandReader(const Tiff &tiff, const std::string &path, const Picture &picture, const Limits &limits);
    void read(uint8_t *row);  // the next row

private:
    void read_band(uint32_t y, uint32_t rows);
    void read_block(uint32_t x, uint32_t y, uint32_t rows, uint16_t plane);
    void check_block(uint64_t bytes) const;
    [[noreturn]] void fail() const;

    const Tiff &tiff_;
    const std::string &path_;
    const Picture &picture_;
    const Limits limits_;
    const bool tiled_, by_row_, inverted_;
    const size_t sample_bytes_, pixel_bytes_, row_bytes_;  // of the frame
    const uint16_t planes_;
    const size_t block_pixel_bytes_;
    uint32_t block_width_ = 0, block_height_ = 0, next_ = 0;
    LazyBytes band_{nullptr, std::free};
    std::unique_ptr<uint8_t[]> block_;  // not cleared: a damaged header may declare a large size
    size_t block_bytes_ = 0;
};

BandReader::BandReader(const Tiff &tiff, const std::string &path, const Picture &picture, const Limits &limits)
    : tiff_(tiff),
      path_(path),
      picture_(picture),
      limits_(limits),
      tiled_(TIFFIsTiled(tiff.handle) != 0),
      by_row_(!tiled_ && tiff.field<uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_CONTIG),
      inverted_(tiff.field<uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == PHOTOMETRIC_MINISWHITE),
      sample_bytes_(lensprof_sample_type_bytes(picture.sample)),
      pixel_bytes_(static_cast<size_t>(pixel_bytes(picture))),
      row_bytes_(pixel_bytes_ * picture.frame_width),
      planes_(tiff.field<uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE
                  ? static_cast<uint16_t>(lensprof_layout_samples(picture.layout))
                  : uint16_t(1)),
      block_pixel_bytes_(planes_ > 1 ? sample_bytes_ : pixel_bytes_) {
    block_width_ = tiled_ ? tiff.field<uint32_t>(TIFFTAG_TILEWIDTH, 0) : picture.frame_width;
    block_height_ = tiled_ ? tiff.field<uint32_t>(TIFFTAG_TILELENGTH, 0)
                           : std::min(tiff.field<uint32_t>(TIFFTAG_ROWSPERSTRIP, UINT32_MAX), picture.frame_height);
    const uint64_t bytes = tiled_ ? TIFFTileSize64(tiff.handle) : TIFFVStripSize64(tiff.handle, block_height_);
    if (!by_row_ || limits_.decodes_blocks) check_block(bytes);
    if (by_row_) {
        if (static_cast<uint64_t>(TIFFScanlineSize64(tiff.handle)) != row_bytes_) fail();
        return;
    }
    block_bytes_ = static_cast<size_t>(bytes);
    block_.reset(new uint8_t[block_bytes_]);
    band_ = make_lazy_bytes(row_bytes_ * std::min(block_height_, picture.frame_height));
}

void BandReader::check_block(uint64_t bytes) const {
    const uint32_t max_side = limits_.most_side ? limits_.most_side : UINT32_MAX;
    if (block_width_ == 0 || block_height_ == 0 || block_width_ > max_side || block_height_ > max_side
        || bytes > block_max_bytes || bytes != uint64_t(block_width_) * block_height_ * block_pixel_bytes_)
        fail();
}

void BandReader::fail() const {
    fail_damaged(path_, tiff_.message.text[0] ? tiff_.message.text : "invalid size of a strip or tile");
}

void BandReader::read(uint8_t *row) {
    const uint32_t y = next_++;
    if (by_row_) {
        if (TIFFReadScanline(tiff_.handle, row, y, 0) != 1 || tiff_.failed()) fail();
    } else {
        if (y % block_height_ == 0) read_band(y, std::min(block_height_, picture_.frame_height - y));
        std::memcpy(row, band_.get() + y % block_height_ * row_bytes_, row_bytes_);
    }
    if (inverted_) invert_row(picture_, row);
}

void BandReader::read_band(uint32_t y, uint32_t rows) {
    for (uint16_t plane = 0; plane < planes_; ++plane) {
        for (uint64_t x = 0; x < picture_.frame_width; x += block_width_)
            read_block(static_cast<uint32_t>(x), y, rows, plane);
    }
}

void BandReader::read_block(uint32_t x, uint32_t y, uint32_t rows, uint16_t plane) {
    TIFF *handle = tiff_.handle;
    const size_t block_row_bytes = block_width_ * block_pixel_bytes_;
    const tmsize_t wanted = static_cast<tmsize_t>(tiled_ ? block_bytes_ : rows * block_row_bytes);
    const uint32_t number = tiled_ ? TIFFComputeTile(handle, x, y, 0, plane) : TIFFComputeStrip(handle, y, plane);
    check_stored(path_,
                 (tiled_ ? "a tile of " : "a strip of ") + size_text(block_width_, tiled_ ? block_height_ : rows),
                 static_cast<uint64_t>(wanted), tiff_.stored(number), limits_.expansion);
    const tmsize_t count = tiled_ ? TIFFReadEncodedTile(handle, number, block_.get(), wanted)
                                  : TIFFReadEncodedStrip(handle, number, block_.get(), wanted);
    if (count != wanted || tiff_.failed()) fail();
    const size_t columns = std::min(block_width_, picture_.frame_width - x);
    for (size_t i = 0; i < rows; ++i) {
        const uint8_t *from = block_.get() + i * block_row_bytes;
        uint8_t *to = band_.get() + i * row_bytes_ + x * pixel_bytes_ + plane * block_pixel_bytes_;
        if (planes_ == 1) {
            std::memcpy(to, from, columns * pixel_bytes_);
            continue;
        }
        for (size_t c = 0; c < columns; ++c, from += sample_bytes_, to += pixel_bytes_)
            std::memcpy(to, from, sample_bytes_);
    }
}

class TiffSource final : public RowSource {
public:
    explicit TiffSource(const ReadRequest &request);

    void read(uint8_t *row) override {
        if (!reader_) reader_ = std::make_unique<BandReader>(tiff_, path_, header_, limits_);
        reader_->read(row);
    }

private:
    std::string path_;
    Tiff tiff_;
    Limits limits_{};
    std::unique_ptr<BandReader> reader_;
};

// m: no memory map, which would crash the process if the file is truncated while being read.
TiffSource::TiffSource(const ReadRequest &request)
    : path_(request.path), tiff_(request.path, "rm", request.page_offset) {
    if (!tiff_.handle) fail_damaged(path_, tiff_.message.text);
    if (request.page && !request.page_offset && !TIFFSetDirectory(tiff_.handle, request.page))
        fail_damaged(path_, tiff_.message.text[0] ? tiff_.message.text : "the page cannot be found");
    tiff_.message = TiffMessage();  // errors in tags that are not needed
    check_not_raw(tiff_, request);
    read_sample(tiff_, request, header_);
    read_layout(tiff_, request, header_);
    read_traits(tiff_, header_);
    const std::optional<Limits> limits = limits_of(header_.traits.compression);
    if (!limits || !TIFFIsCODECConfigured(header_.traits.compression))
        fail_unsupported(path_, "TIFF compression " + std::to_string(header_.traits.compression)
                                    + " is not supported; convert it first");
    limits_ = *limits;
    set_frame(header_, tiff_.field<uint32_t>(TIFFTAG_IMAGEWIDTH, 0), tiff_.field<uint32_t>(TIFFTAG_IMAGELENGTH, 0),
              request);
    check_stored_frame(tiff_, path_, header_, limits_);
}

// A slice of ImageJ that has no page of its own: it follows the one before it, uncompressed and without a gap.
class SliceSource final : public RowSource {
public:
    SliceSource(const ReadRequest &request, const StackDescription &stack)
        : path_(request.path), file_(open_for_reading(request.path)) {
        const TiffSource first({request.path, request.max_side});
        header_ = first.header();
        const Tiff tiff(path_, "rm");
        row_bytes_ = static_cast<size_t>(pixel_bytes(header_) * header_.frame_width);
        const uint64_t bytes = row_bytes_ * uint64_t(header_.frame_height),
                       offset = TIFFGetStrileOffset(tiff.handle, 0) + bytes * request.page;
        is_swapped_ = TIFFIsByteSwapped(tiff.handle) != 0;
        if (request.page >= stack.images || header_.traits.compression != COMPRESSION_NONE
            || tiff.field<uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == PHOTOMETRIC_MINISWHITE)
            fail_unsupported(path_, "is a stack of ImageJ of an unusual kind; save it as single pictures first");
        if (offset + bytes > tiff.file_bytes()) fail_damaged(path_, "the file ends before this slice");
        if (!system::seek(file_.get(), static_cast<int64_t>(offset), SEEK_SET))
            fail_damaged(path_, "cannot find the slice");
    }

    void read(uint8_t *row) override {
        if (std::fread(row, 1, row_bytes_, file_.get()) != row_bytes_)
            fail_damaged(path_, "the file ends in this slice");
        if (!is_swapped_) return;
        const size_t bytes = lensprof_sample_type_bytes(header_.sample);
        for (uint8_t *sample = row; sample < row + row_bytes_; sample += bytes) std::reverse(sample, sample + bytes);
    }

private:
    std::string path_;
    File file_;
    size_t row_bytes_ = 0;
    bool is_swapped_ = false;
};

// Lossless compressions are kept; recompressing with a lossy one would damage the pixels a second time.
uint16_t compression_to_write(const PictureTraits &traits) {
    static const uint16_t lossless[] = {COMPRESSION_NONE,    COMPRESSION_LZW,  COMPRESSION_ADOBE_DEFLATE,
                                        COMPRESSION_DEFLATE, COMPRESSION_LZMA, COMPRESSION_ZSTD,
                                        COMPRESSION_PACKBITS};
    const uint16_t *end = std::end(lossless);
    const bool keep = std::find(std::begin(lossless), end, traits.compression) != end;
    return keep && TIFFIsCODECConfigured(traits.compression) ? traits.compression : COMPRESSION_ADOBE_DEFLATE;
}

void set_resolution(TIFF *handle, const PictureTraits &traits) {
    using Unit = PictureTraits::Unit;
    if (!(traits.x_resolution > 0 && traits.y_resolution > 0)) return;
    const Unit unit = traits.resolution_unit == Unit::metre ? Unit::centimetre : traits.resolution_unit;
    TIFFSetField(handle, TIFFTAG_XRESOLUTION, convert_resolution(traits.x_resolution, traits.resolution_unit, unit));
    TIFFSetField(handle, TIFFTAG_YRESOLUTION, convert_resolution(traits.y_resolution, traits.resolution_unit, unit));
    TIFFSetField(handle, TIFFTAG_RESOLUTIONUNIT,
                 unit == Unit::inch         ? RESUNIT_INCH
                 : unit == Unit::centimetre ? RESUNIT_CENTIMETER
                                            : RESUNIT_NONE);
}

void set_tags(TIFF *handle, const Picture &picture, uint32_t rows_per_strip) {
    const PictureTraits &traits = picture.traits;
    const unsigned samples = lensprof_layout_samples(picture.layout);
    const bool is_float = picture.sample == LENSPROF_SAMPLE_F32;
    const uint16_t compression = compression_to_write(traits);
    TIFFSetField(handle, TIFFTAG_IMAGEWIDTH, picture.width);
    TIFFSetField(handle, TIFFTAG_IMAGELENGTH, picture.height);
    TIFFSetField(handle, TIFFTAG_BITSPERSAMPLE, 8 * lensprof_sample_type_bytes(picture.sample));
    TIFFSetField(handle, TIFFTAG_SAMPLEFORMAT, is_float ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
    TIFFSetField(handle, TIFFTAG_SAMPLESPERPIXEL, samples);
    TIFFSetField(handle, TIFFTAG_PHOTOMETRIC, samples > 2 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    TIFFSetField(handle, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(handle, TIFFTAG_ORIENTATION, traits.orientation);
    TIFFSetField(handle, TIFFTAG_ROWSPERSTRIP, rows_per_strip);
    TIFFSetField(handle, TIFFTAG_COMPRESSION, compression);
    if (compression != COMPRESSION_NONE && compression != COMPRESSION_PACKBITS)
        TIFFSetField(handle, TIFFTAG_PREDICTOR, is_float ? PREDICTOR_FLOATINGPOINT : PREDICTOR_HORIZONTAL);
    if (samples % 2 == 0) {
        const uint16_t kind = traits.alpha == PictureTraits::Alpha::associated     ? EXTRASAMPLE_ASSOCALPHA
                              : traits.alpha == PictureTraits::Alpha::unassociated ? EXTRASAMPLE_UNASSALPHA
                                                                                   : EXTRASAMPLE_UNSPECIFIED;
        TIFFSetField(handle, TIFFTAG_EXTRASAMPLES, 1, &kind);
    }
    set_resolution(handle, traits);
    if (!picture.icc.empty())
        TIFFSetField(handle, TIFFTAG_ICCPROFILE, static_cast<uint32_t>(picture.icc.size()), picture.icc.data());
}

class TiffSink final : public RowSink {
public:
    TiffSink(const std::string &path, const Picture &header);
    void write(const uint8_t *row) override;
    void finish() override;

private:
    void write_strip();
    [[noreturn]] void fail() const { fail_to_write(path_, tiff_.message.text, tiff_.message.error_number); }

    std::string path_;
    const size_t row_bytes_;
    const uint32_t rows_per_strip_;
    Tiff tiff_;
    std::vector<uint8_t> strip_;  // rows to write; libtiff may modify its input
    uint32_t strips_ = 0;
};

size_t frame_row_bytes(const Picture &header) { return static_cast<size_t>(pixel_bytes(header) * header.width); }

TiffSink::TiffSink(const std::string &path, const Picture &header)
    : path_(path),
      row_bytes_(frame_row_bytes(header)),
      rows_per_strip_(static_cast<uint32_t>(
          std::min<size_t>(std::max<size_t>(1, strip_bytes / std::max<size_t>(1, row_bytes_)), header.height))),
      tiff_(path, row_bytes_ * uint64_t(header.height) > classic_max_bytes ? "w8" : "w") {
    if (!tiff_.handle) fail();
    set_tags(tiff_.handle, header, rows_per_strip_);
    strip_.reserve(row_bytes_ * rows_per_strip_);
}

void TiffSink::write(const uint8_t *row) {
    strip_.insert(strip_.end(), row, row + row_bytes_);
    if (strip_.size() == row_bytes_ * rows_per_strip_) write_strip();
}

void TiffSink::write_strip() {
    errno = 0;  // an error found by libtiff itself has no number
    if (TIFFWriteEncodedStrip(tiff_.handle, strips_++, strip_.data(), static_cast<tmsize_t>(strip_.size())) < 0) fail();
    strip_.clear();
}

// Closing writes the directory; only the handler knows whether that succeeded.
void TiffSink::finish() {
    if (!strip_.empty()) write_strip();
    errno = 0;
    const bool flushed = TIFFFlush(tiff_.handle) == 1;
    tiff_.close();
    if (!flushed || tiff_.message.text[0] != '\0') fail();
}

}  // namespace

std::unique_ptr<RowSource> open_tiff(const ReadRequest &request) {
    if (request.page && !request.page_offset) {
        Tiff tiff(request.path, "rm");
        const StackDescription stack = tiff.handle ? stack_description(tiff) : StackDescription{};
        if (stack.images > 1 && TIFFNumberOfDirectories(tiff.handle) == 1)
            return std::make_unique<SliceSource>(request, stack);
    }
    return std::make_unique<TiffSource>(request);
}

std::unique_ptr<RowSink> create_tiff(const std::string &path, const Picture &header) {
    errno = 0;
    return std::make_unique<TiffSink>(path, header);
}

}  // namespace codec

}  // namespace lensprof
