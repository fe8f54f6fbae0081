// Picture files: PNG, TIFF and JPEG in and out; camera raw files, HEIC, AVIF, WebP and JPEG XL in.
//
// Pixels come as the file stores them: pixel (0, 0) is the first one of the file, the EXIF orientation is kept but
// not applied, no colour management. All functions throw Failure; its text names the file and the next step.
// Threads: any function may run in several threads at once on different pictures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <lensprof/apply.h>

#include "cli/pictures/metadata.hpp"
#include "cli/program/output_file.hpp"

namespace lensprof {

enum class FileFormat {
    png,
    tiff,
    jpeg,
    raw,   // is read
    exr,   // is written
    heif,  // is read, as are the next two: HEIC, AVIF
    webp,
    jxl
};

// What rewriting a picture must keep beside pixels and metadata. Each writer uses what its format can express.
struct PictureTraits {
    enum class Unit {
        none,
        inch,
        centimetre,
        metre
    };  // none: only the ratio of the two is meant
    enum class Alpha {
        unspecified,
        associated,
        unassociated
    };

    FileFormat format = FileFormat::png;        // of the file that was read
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

    // Values were rounded over blocks of pixels: JPEG, and HEIF, WebP and JPEG XL unless they are known to be lossless.
    bool is_lossy = false;

    // JPEG: the tables are kept as they are, which is the source's quality exactly.
    std::vector<std::array<uint16_t, 64>> quantisation;  // luminance, then chrominance; natural order
    int chroma_step_x = 1, chroma_step_y = 1;            // pixels per chroma sample
    bool progressive = false;
};

// A picture in memory: rows from top to bottom without gaps, samples in native byte order, aligned.
struct Picture {
    uint32_t width = 0, height = 0;              // of the pixels held
    uint32_t frame_width = 0, frame_height = 0;  // of the file's full frame
    uint32_t reduction = 1;                 // side in frame pixels of the square that one held pixel is the mean of
    uint32_t sample = LENSPROF_SAMPLE_U8;   // lensprof_sample_type
    uint32_t layout = LENSPROF_LAYOUT_RGB;  // lensprof_layout: GREY, GREY_ALPHA, RGB or RGBA
    size_t row_bytes = 0;
    std::vector<uint8_t> pixels;  // row_bytes * height
    std::vector<uint8_t> icc;     // colour profile of the file, may be empty
    PictureTraits traits;

    lensprof_image view();  // valid until pixels is changed
};

struct ReadOptions {
    // 0 = full size. Otherwise every held pixel stands for a square of the frame, whose side is 1 or the largest even
    // number that leaves the longer side of the picture at or above max_side. Its value is that of one block of 2 x 2
    // pixels in the square, in different places from square to square: the mean of the middle two of the four (PNG and
    // TIFF, all samples alike, alpha too), or what the inverse DCT makes of them, which is near their mean (JPEG). In a
    // mean of the whole square every wrong pixel would have a share, and no square would be without one; so most held
    // pixels are good ones. Held pixel (x, y) covers the frame's pixels from (x, y) * reduction on; up to reduction - 1
    // columns and rows at the right and lower edge are left out.
    uint32_t max_side = 0;
};

struct WriteOptions {
    std::string metadata_from;  // EXIF, IPTC and XMP are copied from this file, which may be the one written over
    std::optional<CorrectionMark> mark;         // put in with that copy
    const PictureMetadata *metadata = nullptr;  // written as EXIF (after the copy)
    int jpeg_quality = 0;                       // 1..100; 0 = the tables the picture was read with, else 95
};

// Largest side, and most bytes of the pixels of a frame.
constexpr uint32_t picture_max_side = 1u << 20;
constexpr uint64_t picture_max_bytes = uint64_t(8) << 30;

// Most bytes of coefficients that are held in memory while a JPEG is written. Those of larger pictures pass through a
// file, which costs no more time where the system has memory to spare.
constexpr uint64_t jpeg_memory_bytes = uint64_t(16) << 20;

// Reads PNG (all kinds; palette, 1, 2 and 4 bits and transparent colours are expanded), TIFF (8 and 16 bit unsigned,
// 32 bit float; grey or RGB, at most one extra sample; first page) or JPEG (grey, YCbCr, RGB), by content whatever the
// name. 0 = black, also for min-is-white files. NaN and infinity in float files are kept.
// Camera raw files (with LibRaw) are 16 bit RGB, or grey, of linear light in the camera's own colours, without white
// balance: 0 is black, and exactly what is saturated is 65535. The frame is the sensor's visible area, unturned. A
// mosaic that is reduced has channels of its 2 x 2 cells; at full size they are interpolated.
// HEIC and AVIF (with libheif), WebP (libwebp) and JPEG XL (libjxl) have 8 bit, or 16 where the file has more, of the
// full scale, or 32 bit float (JPEG XL); the primary one of several pictures, as it was before the file's own rotation
// and mirroring, which are in traits.orientation. Animations and values of PQ and HLG are Failures.
Picture read_picture(const std::string &path, const ReadOptions &options = {});

// The same without pixels: sizes (for these options), sample, layout, profile, traits.
Picture read_header(const std::string &path, const ReadOptions &options = {});

// Whether the program was built with LibRaw, libheif, libwebp, libjxl.
bool can_read_raw();
bool can_read_heif();
bool can_read_webp();
bool can_read_jxl();

// The largest JPEG that a camera raw file has in it, as a picture. Failure (unreadable) where there is none.
Picture read_raw_preview(const std::string &path, const ReadOptions &options = {});

// Size of the full frame.
PictureSize read_size(const std::string &path);

namespace codec {
class RowSource;
class RowSink;
}  // namespace codec

// A picture read from the top in strips of whole rows, full size. Held in memory is what the format's smallest unit
// asks for, whatever the picture's height: a row of PNG, of JPEG those of a block, a strip of TIFF (compressed) or a
// row of its tiles. An interlaced PNG is decoded as a whole, as are HEIC, AVIF, WebP and JPEG XL; of a progressive JPEG
// all coefficients are.
class PictureReader {
public:
    explicit PictureReader(const std::string &path);
    ~PictureReader();

    const Picture &header() const;  // without pixels

    // The next rows.height rows into `rows`, of the header's width, sample and layout. With the last one the rest of
    // the file is checked.
    void read(const lensprof_image &rows);

private:
    std::string path_;
    std::unique_ptr<codec::RowSource> source_;
    uint32_t done_ = 0;
};

// Whether the program was built with OpenEXR.
bool can_write_exr();

// The XMP packet in an OpenEXR file that this program wrote; empty for any other file.
std::string exr_xmp_of(const std::string &path);

// The format that a file name asks for: .png, .tif, .tiff, .jpg, .jpeg, .exr in any case; otherwise, and for .exr where
// that cannot be written, Failure (usage).
FileFormat format_of_name(const std::string &path);
bool is_picture_name(const std::string &path);  // it has the end of a picture that can be read

// Writes a picture in the format of the name, metadata included, complete or not at all. A sample type or layout that
// the format cannot hold is a Failure (usage): PNG 8 and 16 bit, JPEG 8 bit without alpha, TIFF everything, OpenEXR 32
// bit float (without metadata, which its readers do not look for).
// TIFF keeps a lossless compression, other pictures get Deflate. A TIFF of 4 GB or more becomes a BigTIFF.
// False when the picture is complete but without the metadata, because one of the files is a BigTIFF.
bool write_picture(const std::string &path, const Picture &picture, const WriteOptions &options = {});

// The same in strips of whole rows from the top. Nothing is at `path` before commit(). A JPEG's coefficients, of
// which the best Huffman tables need all, are in memory up to jpeg_memory_bytes, and beyond in a file without a name
// in the same folder.
class PictureWriter {
public:
    // Of `header` sizes, sample, layout, profile and traits count, not the pixels.
    PictureWriter(const std::string &path, const Picture &header, const WriteOptions &options = {});
    ~PictureWriter();

    // The next rows.height rows.
    void write(const lensprof_image &rows);

    // All rows were given: completes the file beside its final name and makes it durable. False as write_picture.
    bool finish();

    void commit();  // gives the finished file its name

private:
    template <class Call>
    auto named(const Call &call) -> decltype(call());

    std::string path_;
    WriteOptions options_;
    std::unique_ptr<OutputFile> output_;
    std::unique_ptr<codec::RowSink> sink_;
};

}  // namespace lensprof
