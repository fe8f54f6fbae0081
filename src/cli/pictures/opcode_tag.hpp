// DNG opcode lists in TIFF and DNG files.
//
// A list is put in by appending: its bytes and a copy of the raw image's directory with the tag go after the end of
// the file, and the one offset that led to the old directory leads to the copy. Every other byte stays where and as it
// is, so that nothing that this program does not know is lost. Exiv2 writes such files anew, and libtiff does not
// rewrite a SubIFD.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lensprof {

constexpr uint16_t tag_opcode_list2 = 51009;  // gains of the mosaic
constexpr uint16_t tag_opcode_list3 = 51022;  // gains after demosaicing

// What the opcodes of a raw image are and work on.
struct OpcodeLists {
    bool raw = false;                   // a mosaic or linear raw image; else the first image of a plain TIFF
    uint32_t width = 0, height = 0;     // of the active area, px
    uint32_t layout = 0;                // lensprof_layout: of the mosaic, RGB or GREY; UINT32_MAX for another mosaic
    std::vector<uint8_t> list2, list3;  // empty where there is none
};

// Failure (ExitCode::unreadable, with the path) for what is no TIFF, is a BigTIFF, cut off or damaged.
OpcodeLists read_opcode_lists(const std::string &path);

// Copies a file and puts the list into the directory of its raw image: the first one, main or SubIFD, that is a mosaic
// or linear raw and no preview, else the first directory of a plain TIFF. A list that is there already is replaced.
// path_out may be path_in; it appears complete or not at all. Failure as read_opcode_lists, and ExitCode::failed where
// the output cannot be written or would have over 4 GiB.
void write_opcode_list(const std::string &path_in, const std::string &path_out, uint16_t tag,
                       const std::vector<uint8_t> &list);

}  // namespace lensprof
