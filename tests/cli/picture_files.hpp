// Common parts of the tests of picture files: a separate folder, synthetic pictures, and files written by the libraries
// themselves, so that nothing is checked against the code under test.
#pragma once

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include <jpeglib.h>
#include <png.h>
#include <tiffio.h>

#include "photo/base/failure.hpp"
#include "photo/pictures/picture.hpp"

// cmocka 1.1.5 does not declare its functions as C; support.h then includes it a second time.
extern "C" {
#include <cmocka.h>
}

#include "support.h"

namespace picture_files {

using namespace lensprof;
namespace fs = std::filesystem;

using Bytes = std::vector<uint8_t>;

inline fs::path folder;

inline std::string in_folder(const std::string &name) { return (folder / name).string(); }

size_t files_in_folder();

// Reads in blocks, because reading byte by byte takes longer than the tested code. Empty if there is no such file.
Bytes load(const std::string &path);

void save(const std::string &path, const Bytes &bytes);

// The text of the Failure that `call` must throw.
std::string failure_of(lensprof_status status, const std::function<void()> &call);

void assert_failure(lensprof_status status, const std::string &part, const std::function<void()> &call);

// The smallest profile that libpng accepts: a header and no tag (ICC.1:2010 section 7.2); padded to `size`.
Bytes make_profile(bool grey, size_t size);

// Every sample is random, so that an exchange of bytes, rows or channels is detected.
Picture make_noise(uint32_t width, uint32_t height, uint32_t sample, uint32_t layout);

// A picture suited to JPEG.
Picture make_smooth(uint32_t width, uint32_t height, uint32_t layout);

void assert_same_pixels(const Picture &a, const Picture &b);

void assert_near_pixels(const Picture &a, const Picture &b, int levels);

// Files made by the libraries themselves.

struct TiffKind {
    const char *mode = "w";
    uint16_t compression = COMPRESSION_NONE, planar = PLANARCONFIG_CONTIG, photometric = PHOTOMETRIC_MINISBLACK;
    uint32_t tile = 0, rows_per_strip = 7;
    uint16_t bits = 0, format = SAMPLEFORMAT_UINT;  // bits 0: as in the picture
};

void write_block(TIFF *tiff, const Picture &picture, uint32_t x0, uint32_t y0, uint32_t width, uint32_t height,
                 int plane);

void write_tiff_file(const std::string &path, const Picture &picture, const TiffKind &kind);

// Rows are given as the file packs them.
struct PngKind {
    uint32_t width = 0, height = 0;
    int bits = 8, colour = PNG_COLOR_TYPE_RGB, interlace = PNG_INTERLACE_NONE;
    std::function<void(png_structp, png_infop)> extra = [](png_structp, png_infop) {};
};

void write_png_file(const std::string &path, const PngKind &kind, Bytes &packed);

struct JpegKind {
    int quality = 90, step_x = 2, step_y = 2;
    bool progressive = false, cmyk = false, best_tables = false;
};

void write_jpeg_file(const std::string &path, const Picture &picture, const JpegKind &kind);

// Group fixtures: a folder that is removed afterwards.
int make_folder(void **);

int remove_folder(void **);

// Setup of a test: removes everything left by the previous one.
int empty_folder(void **);

}  // namespace picture_files
