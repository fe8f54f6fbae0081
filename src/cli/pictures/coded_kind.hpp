// Which picture file of HEIF's family, WebP or JPEG XL a file is, by its content: no decoder is needed for that.
#pragma once

#include <optional>
#include <string>

#include "cli/pictures/picture.hpp"

namespace lensprof {

struct CodedKind {
    FileFormat format;  // heif, webp or jxl
    const char *name;   // "HEIC", "AVIF", "HEIF", "WebP", "JPEG XL"
};

// Nothing for other files, also for those that cannot be read.
std::optional<CodedKind> coded_kind(const std::string &path);

// By content or name: a copy of it cannot keep the end of its name.
bool is_read_alone(const std::string &path);

// The format that a name ends for: .heic, .heif, .hif, .avif, .webp, .jxl in any case. These are read, not written.
std::optional<CodedKind> coded_kind_of_name(const std::string &path);

}  // namespace lensprof
