// Text with numbers in it.
#pragma once

#include <cstddef>
#include <string>

namespace lensprof {

// printf into a string.
std::string format(const char *pattern, ...) __attribute__((format(printf, 1, 2)));

// "1 profile", "2 lenses"; without `things` with an s.
std::string counted(size_t count, const std::string &thing, const std::string &things = "");

}  // namespace lensprof
