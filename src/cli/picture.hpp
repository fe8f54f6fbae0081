/* picture.hpp - picture files: PNG, TIFF and JPEG in and out.
 *
 * Pixels come as the file stores them: pixel (0, 0) is the first one of the file, the EXIF orientation is kept but
 * not applied, no colour management. All functions throw Failure; its text names the file and the next step.
 * Threads: any function may run in several threads at once on different pictures.
 */
#ifndef LENSPROF_CLI_PICTURE_HPP
#define LENSPROF_CLI_PICTURE_HPP

#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <lensprof/apply.h>

#include "metadata.hpp"

namespace lensprof {

enum class FileFormat { png, tiff, jpeg };

/* What rewriting a picture must keep beside pixels and metadata. Each writer uses what its format can express. */
struct PictureTraits {
    enum class Unit { none, inch, centimetre, metre }; /* none: only the ratio of the two is meant */
    enum class Alpha { unspecified, associated, unassociated };

    FileFormat format = FileFormat::png; /* of the file that was read */
    double x_resolution = 0, y_resolution = 0; /* pixels per unit; 0 = not stated */
    Unit resolution_unit = Unit::none;
    Alpha alpha = Alpha::unassociated; /* associated: colour is premultiplied */

    /* PNG: in the units of the chunks (1/100000). */
    bool has_srgb = false, has_gamma = false, has_chromaticities = false;
    int srgb_intent = 0;
    int32_t gamma = 0;
    std::array<int32_t, 8> chromaticities = {}; /* x, y of white, red, green, blue */

    /* TIFF: numbers of the format. */
    uint16_t compression = 0; /* 0 = not a TIFF */
    uint16_t orientation = 1;

    /* JPEG: the tables are kept as they are, which is the source's quality exactly. */
    std::vector<std::array<uint16_t, 64>> quantisation; /* luminance, then chrominance; natural order */
    int chroma_step_x = 1, chroma_step_y = 1; /* pixels per chroma sample */
    bool progressive = false;
};

/* A picture in memory: rows from top to bottom without gaps, samples in native byte order, aligned. */
struct Picture {
    uint32_t width = 0, height = 0; /* of the pixels held */
    uint32_t frame_width = 0, frame_height = 0; /* of the file's full frame */
    uint32_t reduction = 1; /* side in frame pixels of the square that one held pixel is the mean of */
    uint32_t sample = LENSPROF_SAMPLE_U8; /* lensprof_sample */
    uint32_t layout = LENSPROF_LAYOUT_RGB; /* lensprof_layout: GREY, GREY_ALPHA, RGB or RGBA */
    size_t row_bytes = 0;
    std::vector<uint8_t> pixels; /* row_bytes * height */
    std::vector<uint8_t> icc; /* colour profile of the file, may be empty */
    PictureTraits traits;

    lensprof_image view(); /* valid until pixels is changed */
};

struct ReadOptions {
    /* 0 = full size. Otherwise every held pixel stands for a square of the frame, whose side is 1 or the largest even
     * number that leaves the longer side of the picture at or above max_side. Its value is that of one block of 2 x 2
     * pixels in the square, in different places from square to square: the mean of the middle two of the four (PNG and
     * TIFF, all samples alike, alpha too), or what the inverse DCT makes of them, which is near their mean (JPEG). In a
     * mean of the whole square every wrong pixel would have a share, and no square would be without one; so most held
     * pixels are good ones. Held pixel (x, y) covers the frame's pixels from (x, y) * reduction on; up to reduction - 1
     * columns and rows at the right and lower edge are left out. */
    uint32_t max_side = 0;
};

struct WriteOptions {
    std::string metadata_from; /* EXIF, IPTC and XMP are copied from this file, which may be the one written over */
    const PictureMetadata *metadata = nullptr; /* written as EXIF (after the copy) */
    int jpeg_quality = 0; /* 1..100; 0 = the tables the picture was read with, else 95 */
};

/* Largest side, and most bytes of the pixels of a frame. */
constexpr uint32_t picture_max_side = 1u << 20;
constexpr uint64_t picture_max_bytes = uint64_t(8) << 30;

/* Reads PNG (all kinds; palette, 1, 2 and 4 bits and transparent colours are expanded), TIFF (8 and 16 bit unsigned,
 * 32 bit float; grey or RGB, at most one extra sample; first page) or JPEG (grey, YCbCr, RGB), by content whatever the
 * name. 0 = black, also for min-is-white files. NaN and infinity in float files are kept. */
Picture read_picture(const std::string &path, const ReadOptions &options = {});

/* The same without pixels: sizes (for these options), sample, layout, profile, traits. */
Picture read_header(const std::string &path, const ReadOptions &options = {});

struct PictureSize {
    uint32_t width = 0, height = 0;
};

/* Size of the full frame. */
PictureSize read_size(const std::string &path);

/* The format that a file name asks for: .png, .tif, .tiff, .jpg, .jpeg in any case; otherwise Failure (usage). */
FileFormat format_of_name(const std::string &path);

/* Writes a picture in the format of the name, metadata included, complete or not at all. A sample type or layout that
 * the format cannot hold is a Failure (usage): PNG 8 and 16 bit, JPEG 8 bit without alpha, TIFF everything.
 * TIFF keeps a lossless compression, other pictures get Deflate. A TIFF of 4 GB or more becomes a BigTIFF.
 * False when the picture is complete but without the metadata, because one of the files is a BigTIFF. */
bool write_picture(const std::string &path, const Picture &picture, const WriteOptions &options = {});

/* What the readers and writers share: private to picture*.cpp and metadata.cpp. */
namespace codec {

struct ReadRequest {
    std::string path;
    uint32_t max_side = 0;
    bool header_only = false;
};

Picture read_png(const ReadRequest &request);
Picture read_tiff(const ReadRequest &request);
Picture read_jpeg(const ReadRequest &request);
void write_png(const std::string &path, const Picture &picture);
void write_tiff(const std::string &path, const Picture &picture);
void write_jpeg(const std::string &path, const Picture &picture, int quality);

using File = std::unique_ptr<std::FILE, int (*)(std::FILE *)>;

File open_for_reading(const std::string &path);
File open_for_writing(const std::string &path);
void close_written(File &file, const std::string &path);

[[noreturn]] void fail_damaged(const std::string &path, const std::string &detail);
[[noreturn]] void fail_unsupported(const std::string &path, const std::string &kind_and_next_step);
[[noreturn]] void fail_to_write(const std::string &path, const std::string &detail, int error_number);
[[noreturn]] void fail_to_hold(const std::string &path, const std::string &kind_and_next_step);

/* Sets frame, reduction, size and row_bytes from the frame's size and max_side; sample and layout must be set. */
void set_frame(Picture &picture, uint32_t frame_width, uint32_t frame_height, const ReadRequest &request);

uint64_t pixel_bytes(const Picture &picture);

/* Resolution in another unit; `none` stays as it is. */
double convert_resolution(double value, PictureTraits::Unit from, PictureTraits::Unit to);

/* Takes a picture row by row from the top and keeps it in picture.pixels, reduced as ReadOptions says. The rows may
 * already be halved in both directions (`done` = 2). Memory grows with the rows, so that a damaged header does not claim
 * it. */
class RowSink {
public:
    RowSink(Picture &picture, uint32_t source_width, uint32_t done = 1);

    uint8_t *row(); /* where the next row of the source is to be put, source_width pixels */
    void accept();  /* it is there */

private:
    struct Pick {
        uint32_t x, column; /* pixel of the picture, block that it takes */
    };

    void halve_rows();
    void choose_blocks();
    void pick_from_row();

    Picture &picture_;
    bool halves_;     /* blocks of 2 x 2 pixels become one here */
    uint32_t blocks_; /* along the side of a held pixel's square */
    size_t pixel_bytes_, scratch_row_;
    bool direct_;            /* rows are put straight into the picture */
    bool lower_ = false;     /* the next row is the lower one of blocks */
    uint32_t block_row_ = 0; /* rows of blocks since the last row of the picture */
    uint32_t emitted_ = 0;   /* rows of the picture */
    std::vector<uint8_t> scratch_;
    std::vector<std::vector<Pick>> picks_; /* of the picture's next row, for every row of blocks */
};

/* Runs body() and says false when the C library it calls left it by longjmp(jump). The jump skips no destructor as
 * long as body owns no object that has one while it is inside the library: such objects belong to the caller. GCC and
 * clang never inline a function that calls setjmp, so no variable of the caller can be lost. */
template <class Body> bool guarded(std::jmp_buf &jump, const Body &body) {
    if (setjmp(jump) != 0)
        return false;
    body();
    return true;
}

}  // namespace codec

}  // namespace lensprof

#endif
