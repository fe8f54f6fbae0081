// Kinds of files that no command reads, by their first bytes: videos, pictures of other formats, archives.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace lensprof {

// First bytes of a file that its kind is known by: two packets of an MPEG transport stream, the brands of an MP4.
constexpr size_t kind_bytes = 512;

// "HEIC", "AVIF" or "HEIF" for a picture in ISO/IEC 23008-12's container, which videos and other formats share; NULL
// for other files. `start`: the first bytes, at most kind_bytes.
const char *heif_brand(std::string_view start);

// Failure (unreadable) for a known kind of file that is neither a picture, a project nor a profile; names the kind and
// how to make pictures of it.
void refuse_other_kind(const std::string &path, std::string_view start);

// The same for the file itself; nothing for a path that is not a regular file or cannot be read.
void refuse_other_kind(const std::string &path);

// Pictures in a file of such a kind: not sound, documents or archives.
struct OtherPictures {
    std::string kind;    // "a video (MP4)"
    std::string reason;  // the kind, and how to make pictures of it
};

// Empty for other files, also those that cannot be read.
std::optional<OtherPictures> other_pictures(const std::string &path);

}  // namespace lensprof
