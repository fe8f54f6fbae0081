// Text with numbers in it.
#pragma once

#include <string>

namespace lensprof {

// printf into a string.
std::string format(const char *pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace lensprof
