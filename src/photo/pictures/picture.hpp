// Picture files: reads and writes PNG, TIFF and JPEG; reads camera raw files, HEIC, AVIF, WebP and JPEG XL.
//
// Pixels are returned as stored: pixel (0, 0) is the first of the file, the EXIF orientation is kept but not applied,
// and there is no colour management. All functions throw Failure with the file name and the next step. Threads: any
// function may run in several threads concurrently on different pictures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <lensprof/apply.h>

#include "photo/base/output_file.hpp"
#include "photo/pictures/metadata.hpp"

namespace lensprof {

enum class FileFormat {
    png,
    tiff,
    jpeg,
    raw,   // read only
    exr,   // write only
    heif,  // read only, like the next two: HEIC, AVIF
    webp,
    jxl,
    fits
};

// Properties to keep when a picture is rewritten, other than pixels and metadata. Each writer uses what its format
// supports.
struct PictureTraits {
    enum class Unit {
        none,
        inch,
        centimetre,
        metre
    };  // none: only the ratio of the two is meaningful
    enum class Alpha {
        unspecified,
        associated,
        unassociated
    };

    FileFormat format = FileFormat::png;        // of the source file
    double x_resolution = 0, y_resolution = 0;  // pixels per unit; 0 = not stated
    Unit resolution_unit = Unit::none;
    Alpha alpha = Alpha::unassociated;  // associated: colour is premultiplied

    // PNG: in the units of the chunks (1/100000).
    bool has_srgb = false, has_gamma = false, has_chromaticities = false;
    int srgb_intent = 0;
    int32_t gamma = 0;
    std::array<int32_t, 8> chromaticities = {};  // x, y of white, red, green, blue

    // TIFF: numbers of the format.
    uint16_t compression = 0;  // 0 = not a TIFF
    uint16_t orientation = 1;

    // Values were rounded over blocks of pixels: JPEG, and HEIF, WebP and JPEG XL unless known to be lossless.
    bool is_lossy = false;

    // JPEG: the tables are kept unchanged, which preserves the exact quality of the source.
    std::vector<std::array<uint16_t, 64>> quantisation;  // luminance, then chrominance; natural order
    int chroma_step_x = 1, chroma_step_y = 1;            // pixels per chroma sample
    bool progressive = false;
};

// A picture in memory: rows from top to bottom without gaps, samples in native byte order, aligned.
struct Picture {
    uint32_t width = 0, height = 0;              // of the stored pixels
    uint32_t frame_width = 0, frame_height = 0;  // of the full frame of the file
    uint32_t reduction = 1;                      // side, in frame pixels, of the square averaged into one stored pixel
    uint32_t sample = LENSPROF_SAMPLE_U8;        // lensprof_sample_type
    uint32_t layout = LENSPROF_LAYOUT_RGB;       // lensprof_layout: GREY, GREY_ALPHA, RGB or RGBA
    size_t row_bytes = 0;
    std::vector<uint8_t> pixels;  // row_bytes * height
    std::vector<uint8_t> icc;     // colour profile of the file, may be empty
    PictureTraits traits;

    lensprof_image view() const;  // valid until pixels is changed
    lensprof_target target();
};

// The pixels of a target after they were written.
inline lensprof_image image_of(const lensprof_target &t) {
    return {t.data, t.row_bytes, t.width, t.height, t.sample, t.layout};
}

// The largest number of a sample type: 1.0 for float.
inline double full_scale_of(uint32_t sample) {
    return sample == LENSPROF_SAMPLE_U8 ? 255.0 : sample == LENSPROF_SAMPLE_U16 ? 65535.0 : 1.0;
}

// Sample `n` of a row, 0..1.
inline double sample_value(uint32_t sample, const uint8_t *row, size_t n) {
    uint16_t code;
    float value;
    switch (sample) {
    case LENSPROF_SAMPLE_U8: return row[n] / 255.0;
    case LENSPROF_SAMPLE_U16: std::memcpy(&code, row + 2 * n, sizeof code); return code / 65535.0;
    default: std::memcpy(&value, row + 4 * n, sizeof value); return static_cast<double>(value);
    }
}

struct ReadOptions {
    // 0 = full size. Otherwise every stored pixel represents a square of the frame, whose side is 1 or the largest even
    // number that keeps the longer side of the picture at or above max_side. Its value is that of one block of 2 x 2
    // pixels in the square, at positions that vary from square to square: the mean of the middle two of the four (PNG
    // and TIFF, all samples alike, alpha included), or the result of the inverse DCT, which is close to their mean
    // (JPEG). In a mean of the whole square every bad pixel would have a share, and every square would have one; this
    // way most stored pixels are good. Stored pixel (x, y) covers the frame's pixels from (x, y) * reduction on; up to
    // reduction - 1 columns and rows at the right and lower edge are omitted.
    uint32_t max_side = 0;

    uint32_t page = 0;         // of a TIFF or FITS, from PictureStack::pages; 0 = the first
    uint64_t page_offset = 0;  // from PictureStack::offsets: finds a page without those before it; 0 = not known
};

struct WriteOptions {
    std::string metadata_from;  // EXIF, IPTC and XMP are copied from this file, which may be the one being overwritten
    std::optional<CorrectionMark> mark;         // added to that copy
    const PictureMetadata *metadata = nullptr;  // written as EXIF (after the copy)
    int jpeg_quality = 0;                       // 1..100; 0 = the tables of the source, else 95
};

// Maximum side, and maximum bytes of the pixels of a frame.
constexpr uint32_t picture_max_side = 1u << 20;
constexpr uint64_t picture_max_bytes = uint64_t(8) << 30;

// Maximum bytes of coefficients held in memory while a JPEG is written. Those of larger pictures pass through a file,
// which takes no longer if the system has spare memory.
constexpr uint64_t jpeg_memory_bytes = uint64_t(16) << 20;

// Reads PNG (all kinds; palette, 1, 2 and 4 bits and transparent colours are expanded), TIFF (8 and 16 bit unsigned, 32
// bit float; grey or RGB, at most one extra sample; first page) or JPEG (grey, YCbCr, RGB), identified by content. 0 =
// black, also for min-is-white files. NaN and infinity in float files are kept. Camera raw files (with LibRaw) become
// 16 bit RGB, or grey, of linear light in camera colours, without white balance: 0 is black, and 65535 means exactly
// the saturated pixels. The frame is the visible area of the sensor, unrotated. A reduced mosaic has channels of its 2
// x 2 cells; at full size they are interpolated. HEIC and AVIF (with libheif), WebP (libwebp) and JPEG XL (libjxl)
// become 8 bit, or 16 if the file has more, of full scale, or 32 bit float (JPEG XL); the primary picture of several,
// before the file's own rotation and mirroring, which are in traits.orientation. Animations and values of PQ and HLG
// are Failures. FITS (with cfitsio) becomes 8 or 16 bit of full scale if its samples are such integers without BLANK,
// otherwise 32 bit float, with BSCALE and BZERO applied and NaN for undefined samples; rows in the order of the file.
Picture read_picture(const std::string &path, const ReadOptions &options = {});

// The same without pixels: sizes (for these options), sample, layout, profile, traits.
Picture read_header(const std::string &path, const ReadOptions &options = {});

// Whether the program was built with LibRaw, libheif, libwebp, libjxl, cfitsio.
bool can_read_raw();
bool can_read_heif();
bool can_read_webp();
bool can_read_jxl();
bool can_read_fits();

// The largest JPEG embedded in a camera raw file, as a picture. Failure (unreadable) if not found.
Picture read_raw_preview(const std::string &path, const ReadOptions &options = {});

// Size of the full frame.
PictureSize read_size(const std::string &path);

namespace codec {
class RowSource;
class RowSink;
}  // namespace codec

// A full-size picture read from the top in strips of whole rows. Memory holds only what the smallest unit of the format
// needs, regardless of the height: a row of PNG, a row of blocks of JPEG, a strip of TIFF (compressed) or a row of its
// tiles. An interlaced PNG is decoded as a whole, as are HEIC, AVIF, WebP and JPEG XL; of a progressive JPEG all
// coefficients are held.
class PictureReader {
public:
    explicit PictureReader(const std::string &path);
    ~PictureReader();

    const Picture &header() const;  // without pixels

    // Reads the next rows.height rows into `rows`, of the header's width, sample and layout. With the last row the rest
    // of the file is checked.
    void read(const lensprof_target &rows);

private:
    std::string path_;
    std::unique_ptr<codec::RowSource> source_;
    uint32_t done_ = 0;
};

// Whether the program was built with OpenEXR.
bool can_write_exr();

// The XMP packet in an OpenEXR file written by this program; empty for other files.
std::string exr_xmp_of(const std::string &path);

// The format of a file name: .png, .tif, .tiff, .jpg, .jpeg, .exr in any case; for others, and for .exr if it cannot be
// written, Failure (usage).
FileFormat format_of_name(const std::string &path);
bool is_picture_name(const std::string &path);  // it has the extension of a readable picture

// Writes a picture in the format of the name, metadata included, completely or not at all. Failure (usage) for a sample
// type or layout that the format does not support: PNG 8 and 16 bit, JPEG 8 bit without alpha, TIFF everything, OpenEXR
// 32 bit float (without metadata, which its readers ignore). TIFF keeps a lossless compression, other pictures get
// Deflate. A TIFF of 4 GB or more becomes a BigTIFF. Returns false if the picture is complete but without metadata,
// because one of the files is a BigTIFF.
bool write_picture(const std::string &path, const Picture &picture, const WriteOptions &options = {});

// The same in strips of whole rows from the top. Nothing exists at `path` before commit(). The coefficients of a JPEG,
// all of which are needed for optimal Huffman tables, are held in memory up to jpeg_memory_bytes, beyond that in an
// unnamed file in the same folder.
class PictureWriter {
public:
    // Uses sizes, sample, layout, profile and traits of `header`, not the pixels.
    PictureWriter(const std::string &path, const Picture &header, const WriteOptions &options = {});
    ~PictureWriter();

    // Writes the next rows.height rows.
    void write(const lensprof_image &rows);

    // After all rows: completes the file under a temporary name and makes it durable. Returns false like write_picture.
    bool finish();

    void commit();  // renames the finished file to its name

private:
    template <class Call>
    auto named(const Call &call) -> decltype(call());

    std::string path_;
    WriteOptions options_;
    std::unique_ptr<OutputFile> output_;
    std::unique_ptr<codec::RowSink> sink_;
};

}  // namespace lensprof
