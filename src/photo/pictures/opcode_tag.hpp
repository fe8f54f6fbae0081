// DNG opcode lists in TIFF and DNG files.
//
// A list is added by appending: its bytes and a copy of the raw image's directory with the tag are written after the
// end of the file, and the one offset that pointed to the old directory is redirected to the copy. All other bytes stay
// unchanged, so nothing unknown to this program is lost. Exiv2 rewrites such files, and libtiff cannot rewrite a
// SubIFD.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lensprof {

constexpr uint16_t tag_opcode_list2 = 51009;  // gains of the mosaic
constexpr uint16_t tag_opcode_list3 = 51022;  // gains after demosaicing

// What the opcodes of a raw image are and apply to.
struct OpcodeLists {
    bool raw = false;                   // a mosaic or linear raw image; else the first image of a plain TIFF
    uint32_t width = 0, height = 0;     // of the active area, px
    uint32_t layout = 0;                // lensprof_layout: of the mosaic, RGB or GREY; UINT32_MAX for another mosaic
    std::vector<uint8_t> list2, list3;  // empty if missing
};

// Failure (unreadable, with the path) for a file that is not a TIFF, is a BigTIFF, truncated or damaged.
OpcodeLists read_opcode_lists(const std::string &path);

// Copies a file and writes the list into the directory of its raw image: the first one, main or SubIFD, that is a
// mosaic or linear raw and not a preview, else the first directory of a plain TIFF. An existing list is replaced.
// path_out may equal path_in; it is written completely or not at all. Failure as for read_opcode_lists, and (failed) if
// the output cannot be written or would exceed 4 GiB.
void write_opcode_list(const std::string &path_in, const std::string &path_out, uint16_t tag,
                       const std::vector<uint8_t> &list);

}  // namespace lensprof
