// Identifies camera raw files by content, without a decoder.
#pragma once

#include <optional>
#include <string>

namespace lensprof {

// "Nikon NEF", "DNG" and so on; empty for other files, including unreadable ones. A TIFF-based file is raw if it has a
// mosaic or linear raw image, or the extension of a raw file.
std::optional<std::string> raw_kind(const std::string &path);

// File extensions of camera raw files, in any case: .cr2, .nef, .dng and so on.
bool is_raw_name(const std::string &path);
bool is_dng_name(const std::string &path);

}  // namespace lensprof
