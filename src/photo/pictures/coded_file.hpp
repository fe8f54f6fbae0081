// HEIF, WebP and JPEG XL files, which are decoded as a whole: private to picture_*.cpp, *_unavailable.cpp and
// coded_*.cpp.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "photo/pictures/codec.hpp"
#include "photo/pictures/coded_kind.hpp"

namespace lensprof {

namespace codec {

// Maximum bytes of decoded pixels, also for a WebP in a TIFF: a few bytes may encode a uniform frame, so the size in a
// header cannot be checked against the file size.
constexpr uint64_t coded_max_bytes = uint64_t(1) << 30;

// Content of a file other than its pixels.
struct CodedMetadata {
    std::vector<uint8_t> exif, xmp, icc;  // exif: starts at its TIFF header; empty if missing
    uint32_t width = 0, height = 0;       // as PictureReader returns them
    uint16_t orientation = 0;             // orientation of the format itself, in EXIF's numbering, replaces that of
                                          // EXIF; 0 = none
    bool is_camera_jpeg = false;          // contains a JPEG file that can be restored
};

CodedMetadata webp_metadata(const std::string &path);
CodedMetadata heif_metadata(const std::string &path, const std::string &kind);
CodedMetadata jxl_metadata(const std::string &path);
CodedMetadata fits_metadata(const std::string &path);

// The planes of the images in a FITS file.
struct FitsPlanes {
    std::vector<uint32_t> numbers;    // of the planes with the size of the first
    std::vector<std::string> others;  // images of another size: "part 3, 40 x 30 px"
    bool is_damaged = false;          // what follows the last part is not one
};
FitsPlanes fits_planes(const std::string &path);

// What a HEIF file holds in addition to its primary picture, except thumbnails.
struct HeifParts {
    uint32_t pictures = 0;  // of their own, the primary one included
    bool is_sequence = false;
    std::vector<std::string> names;  // of auxiliary ones, for messages: "a gain map (HDR)"
};

HeifParts heif_parts(const std::string &path, const std::string &kind);

// Rows of a picture that is decoded when the first row is requested.
class DecodedSource : public RowSource {
public:
    void read(uint8_t *row) override;

protected:
    explicit DecodedSource(const std::string &path) : path_(path) {}

    virtual void decode(uint8_t *pixels, size_t bytes) = 0;  // the whole frame, without gaps

    std::string path_;

private:
    LazyBytes pixels_{nullptr, std::free};
    uint32_t next_ = 0;
};

// set_frame, with the limits of these formats.
void set_coded_frame(Picture &picture, uint32_t width, uint32_t height, const ReadRequest &request);

// Refuses PQ and HLG (ITU-R BT.2100), which encode light for a display or a scene of absolute or very wide range.
[[noreturn]] void fail_hdr(const std::string &path, const std::string &kind, const std::string &transfer);
[[noreturn]] void fail_animated(const std::string &path, const std::string &kind);

// The EXIF block starting at its TIFF header: some writers add the six bytes that precede it in a JPEG.
std::vector<uint8_t> without_exif_mark(const uint8_t *bytes, size_t count);

// The same for an item of HEIF or a box of JPEG XL (ISO/IEC 23008-12, annex A.2.1): its first four bytes state how many
// others precede the TIFF header. Empty if that is out of range.
std::vector<uint8_t> exif_of_item(const std::vector<uint8_t> &item);

}  // namespace codec

}  // namespace lensprof
