// Which format a file is of.
#pragma once

#include <string_view>

#include <lensprof/formats.h>

namespace lensprof {

constexpr uint32_t kWrittenOnly = 2;  // is_written of formats that are not read

// By the ending of a name; AUTO where that is of none.
uint32_t format_of_name(std::string_view name);

// By content, then by name; AUTO where neither decides.
uint32_t detect_format(std::string_view data, std::string_view name);

// A picture, in which other bytes may stand: PNG, JPEG or TIFF.
bool is_picture(std::string_view data);

// Whether the ending is that of tables which are read and not written (pfstools' .m).
bool is_read_only(std::string_view name);

}  // namespace lensprof
