// UTF-8 in texts of any origin: names of files, EXIF, words of the command line.
#pragma once

#include <string>

namespace lensprof {

// Bytes of the UTF-8 character at `at` (Unicode 15, table 3-7: neither overlong forms nor surrogates); 0 where there is
// none.
size_t utf8_length(const std::string &text, size_t at);

bool is_utf8(const std::string &text);

// The longest start of `text`, of at most `bytes` bytes, that does not cut a UTF-8 character.
size_t utf8_cut(const std::string &text, size_t bytes);

// A line for a terminal: control characters, those of two bytes (U+0080 to U+009F) among them, as \xNN, and of more
// than 2000 bytes the start and the end.
std::string one_line(const std::string &text);

}  // namespace lensprof
