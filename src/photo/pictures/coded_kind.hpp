// Identifies HEIF family, WebP, JPEG XL and FITS files by content, without a decoder.
#pragma once

#include <optional>
#include <string>

#include "photo/pictures/picture.hpp"

namespace lensprof {

struct CodedKind {
    FileFormat format;  // heif, webp, jxl or fits
    const char *name;   // "HEIC", "AVIF", "HEIF", "WebP", "JPEG XL", "FITS"
};

// Empty for other files, including unreadable ones.
std::optional<CodedKind> coded_kind(const std::string &path);

// By content or name. A corrected copy cannot keep this extension.
bool is_read_alone(const std::string &path);

// The format of a file extension: .heic, .heif, .hif, .avif, .webp, .jxl, .fits, .fit, .fts in any case. These are
// read, not written.
std::optional<CodedKind> coded_kind_of_name(const std::string &path);

}  // namespace lensprof
