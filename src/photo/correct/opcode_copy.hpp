// Falloffs as opcodes of a TIFF or DNG, whose pixels stay.
#pragma once

#include <string>

#include <lensprof/formats.h>

namespace lensprof {

// Whether the opcodes of a DNG or TIFF correct a falloff.
bool has_falloff_opcode(const std::string &path);

// Copies a DNG with the falloff as an opcode, replacing an existing one; pixels and everything else stay unchanged.
// Failure if other opcodes would be lost.
void write_opcodes(const std::string &path_in, const std::string &path_out, const lensprof_profile &profile);

// The same with options of the format; `path_out` may be the file itself.
void write_opcodes_as(const std::string &path, const std::string &path_out, lensprof_export_options options,
                      const lensprof_profile &profile);

}  // namespace lensprof
