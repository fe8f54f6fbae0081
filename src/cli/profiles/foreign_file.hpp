// Profiles from and to the files of other programs (docs/formats.md): which format a file is of, and
// its bytes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "cli/program/error.hpp"

namespace lensprof {

// One format, as the library knows it.
using ForeignRule = lensprof_format_info;
std::string about_foreign(bool written_only);  // for --help: a line a format

// What files do not say themselves.
struct ForeignOptions {
    uint32_t width = 0, height = 0;  // of the frame, px; 0 = not given
    uint32_t columns = 0, rows = 0;  // of tables and maps; 0 = as the format has them
    uint32_t curve = LENSPROF_CURVE_INVERSE;
    uint32_t depth = 16;  // bits of a map as PNG
    double color_temperature_k = LENSPROF_UNKNOWN;
    std::string sense;  // of maps: attenuation, gain, or empty: PNG the one, TIFF the other
    uint32_t opcode = LENSPROF_DNG_AUTO;
};

// By --format; where that is empty, by the file's content, then its name. Failure (usage or unreadable) names it.
const ForeignRule &format_to_read(const std::string &path, const std::string &wanted);
const ForeignRule &format_to_write(const std::string &path, const std::string &wanted);

// Calls visit for every profile of a file of profiles. Failure (unreadable) names the file.
void read_profiles(const ForeignRule &rule, const std::string &path, lensprof_import_visitor visit, void *user);

// Calls visit for every camera of a Lensfun database. Failure (unreadable) names the file.
void read_cameras(const std::string &path, lensprof_camera_visitor visit, void *user);

// Puts the response, or the falloff with doubt and what is known of the key, of a file into a profile.
void read_part(const ForeignRule &rule, const std::string &path, const ForeignOptions &options,
               lensprof_profile &profile);

// The bytes of a file that would hold these profiles. Failure (usage) for what needs a picture: maps and opcodes.
std::string foreign_bytes(const ForeignRule &rule, const std::string &path, const ForeignOptions &options,
                          const std::vector<const lensprof_profile *> &profiles, const std::vector<std::string> &names);

// Writes the profiles, one where the format holds one. Complete or not at all; opcodes go into the TIFF or DNG that is
// there. Failure names the file and, by its name in `names`, the profile, and says what the format cannot hold.
void write_foreign(const ForeignRule &rule, const std::string &path, const ForeignOptions &options,
                   const std::vector<const lensprof_profile *> &profiles, const std::vector<std::string> &names);

// Whether the opcodes of a DNG or TIFF correct a falloff.
bool has_falloff_opcode(const std::string &path);

// Copies a DNG with the falloff as an opcode in place of one that is there; pixels and all else stay as they are.
// Failure where other opcodes would be lost.
void write_opcodes(const std::string &path_in, const std::string &path_out, const lensprof_profile &profile);

}  // namespace lensprof
