// Profiles from and to files of other programs (docs/formats.md): identification of the format, and the bytes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "photo/base/failure.hpp"

namespace lensprof {

// A format, as the library describes it.
using ForeignRule = lensprof_format_info;
bool is_offered(const ForeignRule &rule, bool to_write);  // whether it is written, or else read
std::string about_foreign(bool to_write);                 // for --help: one line per format

// Information that files do not contain.
struct ForeignOptions {
    uint32_t width = 0, height = 0;  // of the frame, px; 0 = not given
    uint32_t columns = 0, rows = 0;  // of tables and maps; 0 = default of the format
    uint32_t curve = LENSPROF_CURVE_INVERSE;
    uint32_t depth = 16;  // bits of a map as PNG
    double color_temperature_k = LENSPROF_UNKNOWN;
    bool strict = false;  // refuse responses that decrease anywhere
    std::string sense;    // of maps: attenuation, gain, or empty: attenuation for PNG, gain for TIFF
    uint32_t opcode = LENSPROF_DNG_AUTO;
};

// The format given by --format; if that is empty, identified by content, then by name. Failure (usage or unreadable)
// with the file name.
const ForeignRule &format_to_read(const std::string &path, const std::string &format_name);
const ForeignRule &format_to_write(const std::string &path, const std::string &format_name);

// Calls visit for every profile of a file of profiles. Failure (unreadable) names the file.
void read_profiles(const ForeignRule &rule, const std::string &path, lensprof_import_visitor visit, void *user);

// Calls visit for every camera of a Lensfun database. Failure (unreadable) names the file.
void read_cameras(const std::string &path, lensprof_camera_visitor visit, void *user);

// Stores the response, or the falloff with known key fields, of a file in a profile, and adds its doubt and source.
// Returns the largest change that made a response increasing, levels (lensprof_import_entry.change).
double read_part(const ForeignRule &rule, const std::string &path, const ForeignOptions &options,
                 lensprof_profile &profile);

// The bytes of a file with these profiles. Failure (usage) for formats that need a picture: maps and opcodes.
std::string foreign_bytes(const ForeignRule &rule, const std::string &path, const ForeignOptions &options,
                          const std::vector<const lensprof_profile *> &profiles, const std::vector<std::string> &names);

// Writes the profiles, one if the format holds only one, completely or not at all; opcodes are written into an existing
// TIFF or DNG. Failure with the file, the profile's name in `names`, and what the format does not support.
void write_foreign(const ForeignRule &rule, const std::string &path, const ForeignOptions &options,
                   const std::vector<const lensprof_profile *> &profiles, const std::vector<std::string> &names);

}  // namespace lensprof
