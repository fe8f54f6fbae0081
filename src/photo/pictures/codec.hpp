// Shared by the readers and writers of picture files: private to picture*.cpp, row_reducer.cpp and metadata*.cpp. Each
// format is a source of rows and a sink of rows.
#pragma once

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "photo/pictures/picture.hpp"

namespace lensprof {

namespace codec {

struct ReadRequest {
    std::string path;
    uint32_t max_side = 0;
    const std::vector<uint8_t> *bytes = nullptr;  // a JPEG in memory; path is its name
    uint32_t page = 0;                            // ReadOptions::page
    uint64_t page_offset = 0;                     // ReadOptions::page_offset
};

// A picture file being read. Nothing is decoded before the first row is requested.
class RowSource {
public:
    virtual ~RowSource() = default;
    RowSource(const RowSource &) = delete;
    RowSource &operator=(const RowSource &) = delete;

    const Picture &header() const { return header_; }  // without pixels

    // 1, or 2: rows are those of the frame halved in both directions.
    virtual uint32_t halved() const { return 1; }

    // Rows to read, and pixels per row.
    virtual uint32_t row_count() const { return header_.frame_height; }
    virtual uint32_t row_width() const { return header_.frame_width; }

    virtual void read(uint8_t *row) = 0;  // the next row
    virtual void finish() {}              // after all rows: checks the rest of the file

protected:
    RowSource() = default;

    Picture header_;
};

std::unique_ptr<RowSource> open_png(const ReadRequest &request);
std::unique_ptr<RowSource> open_tiff(const ReadRequest &request);
std::unique_ptr<RowSource> open_jpeg(const ReadRequest &request);
// `kind` as raw_kind names it.
std::unique_ptr<RowSource> open_raw(const ReadRequest &request, const std::string &kind);
// `kind` as coded_kind names it.
std::unique_ptr<RowSource> open_heif(const ReadRequest &request, const std::string &kind);
std::unique_ptr<RowSource> open_webp(const ReadRequest &request);
std::unique_ptr<RowSource> open_jxl(const ReadRequest &request);
std::unique_ptr<RowSource> open_fits(const ReadRequest &request);

// A picture file being written.
class RowSink {
public:
    virtual ~RowSink() = default;
    RowSink(const RowSink &) = delete;
    RowSink &operator=(const RowSink &) = delete;

    virtual void write(const uint8_t *row) = 0;  // the next row, without gaps between pixels
    virtual void finish() = 0;                   // after all rows: completes and closes the file

protected:
    RowSink() = default;
};

std::unique_ptr<RowSink> create_png(const std::string &path, const Picture &header);
std::unique_ptr<RowSink> create_tiff(const std::string &path, const Picture &header);
// `xmp`: a packet for the attribute "xmp"; or empty.
std::unique_ptr<RowSink> create_exr(const std::string &path, const Picture &header, const std::string &xmp);
std::unique_ptr<RowSink> create_jpeg(const std::string &path, const Picture &header, int quality);

using File = std::unique_ptr<std::FILE, int (*)(std::FILE *)>;

File open_for_reading(const std::string &path);
File open_for_writing(const std::string &path);
uint64_t file_bytes(std::FILE *file);
void close_written(File &file, const std::string &path);

[[noreturn]] void fail_damaged(const std::string &path, const std::string &detail);
[[noreturn]] void fail_unsupported(const std::string &path, const std::string &kind_and_next_step);
[[noreturn]] void fail_memory(const std::string &path);
[[noreturn]] void fail_to_write(const std::string &path, const std::string &detail, int error_number);
[[noreturn]] void fail_to_hold(const std::string &path, const std::string &kind_and_next_step);

// Sets frame, reduction, size and row_bytes from frame size and max_side; sample and layout must be set.
void set_frame(Picture &picture, uint32_t frame_width, uint32_t frame_height, const ReadRequest &request);

uint64_t pixel_bytes(const Picture &picture);

// Maximum expansion of Deflate per byte: 258 with a length and a distance code of one bit each.
constexpr uint64_t deflate_expansion = 1032;

// "W x H pixels"
std::string size_text(uint64_t width, uint64_t height);

// Fails if `needed` bytes of samples cannot come from `stored` bytes of a file, each of which expands to at most
// `expansion` bytes (0 = unlimited). `declared` describes what needs them, with the size in the header. If `file_bytes`
// is less than `stored`, parts of the file are counted several times.
void check_stored(const std::string &path, const std::string &declared, uint64_t needed, uint64_t stored,
                  uint64_t expansion, uint64_t file_bytes = UINT64_MAX);

// Zeros, whose pages the system provides on first write: a damaged header may declare a large size.
using LazyBytes = std::unique_ptr<uint8_t[], void (*)(void *)>;
LazyBytes make_lazy_bytes(size_t count);

// Converts a resolution to another unit; `none` stays unchanged.
double convert_resolution(double value, PictureTraits::Unit from, PictureTraits::Unit to);

// Runs body(); returns false if the C library that it calls left it by longjmp(jump). The jump skips no destructor as
// long as body owns no object with a destructor while inside the library: such objects belong to the caller. GCC and
// clang never inline a function that calls setjmp, so no variable of the caller is lost.
template <class Body>
bool guarded(std::jmp_buf &jump, const Body &body) {
    if (setjmp(jump) != 0) return false;
    body();
    return true;
}

}  // namespace codec

}  // namespace lensprof
