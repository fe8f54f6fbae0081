// UTF-8 in text from any source: file names, EXIF, the command line.
#pragma once

#include <string>

namespace lensprof {

// Length of the UTF-8 character at `at` (Unicode 15, table 3-7: neither overlong forms nor surrogates); 0 if invalid.
size_t utf8_length(const std::string &text, size_t offset);

bool is_utf8(const std::string &text);

// The longest prefix of `text`, at most `bytes` bytes, that does not split a UTF-8 character.
size_t utf8_cut(const std::string &text, size_t bytes);

// A line for a terminal: control characters, including the two-byte ones (U+0080 to U+009F), are written as \xNN, and
// text of more than 2000 bytes is shortened to its start and end.
std::string one_line(const std::string &text);

// The same as valid UTF-8, for cairo: invalid bytes become question marks.
std::string valid_line(const std::string &text);

}  // namespace lensprof
