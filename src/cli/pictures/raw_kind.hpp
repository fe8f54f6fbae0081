// Which camera raw file a file is, by its content: no decoder is needed for that.
#pragma once

#include <optional>
#include <string>

namespace lensprof {

// "Nikon NEF", "DNG" and so on; nothing for other files, also for those that cannot be read. A file with the structure
// of a TIFF is raw when it has an image of a mosaic or of linear raw values, or the name of a raw file.
std::optional<std::string> raw_kind(const std::string &path);

// Names that cameras give to raw files, in any case: .cr2, .nef, .dng and so on.
bool is_raw_name(const std::string &path);
bool is_dng_name(const std::string &path);

}  // namespace lensprof
