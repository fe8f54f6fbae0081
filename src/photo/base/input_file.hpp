// Files that are read completely: projects, points, profiles of other programs.
#pragma once

#include <cstdint>
#include <string>

namespace lensprof {

// Maximum bytes of a text file, as in the library.
constexpr uint64_t max_text_bytes = uint64_t(64) << 20;

// Failure (unreadable) for an existing path that is neither a regular file nor a folder: devices are endless, pipes
// block, and both can be read only once.
void require_regular_file(const std::string &path);

// The whole file, at most `max_bytes`; Failure (unreadable) with its name. A larger file is refused before reading.
std::string read_text(const std::string &path, uint64_t max_bytes);

// The first `max_bytes` of a file, or all of a smaller one; Failure (unreadable) with its name.
std::string read_head(const std::string &path, size_t max_bytes);

}  // namespace lensprof
