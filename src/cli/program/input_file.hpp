// Files that are read as a whole: projects, points, profiles of other programs.
#pragma once

#include <cstdint>
#include <string>

namespace lensprof {

// Most bytes of a file of text, as the library reads them.
constexpr uint64_t largest_text = uint64_t(64) << 20;

// Failure (unreadable) for what exists and is neither a file nor a folder: devices have no end, pipes are waited for,
// and both can be read only once.
void demand_ordinary(const std::string &path);

// The whole file, of at most `most_bytes`; Failure (unreadable) names it. A larger one is refused before it is read.
std::string read_text(const std::string &path, uint64_t most_bytes);

// The first `most_bytes` of a file, or all of a smaller one; Failure (unreadable) names it.
std::string read_head(const std::string &path, size_t most_bytes);

}  // namespace lensprof
