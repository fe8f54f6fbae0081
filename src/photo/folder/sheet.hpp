// Small copies of the pictures, and contact sheets of them.
#pragma once

#include "photo/folder/corrections.hpp"

namespace lensprof {

// A small copy of an input picture or of its corrected copy, upright; empty if the file cannot be read, because it may
// have been edited since.
Picture small_copy(const std::string &file, const InputPicture &picture, uint32_t side);

// calibrate_sheet.jpg and, if one page is not enough, calibrate_sheet2.jpg and so on.
std::vector<std::string> sheet_names(const FolderOptions &o, size_t pictures);

// Writes the sheets, with name and exposure of each picture. A sheet that the ledger lists with the same copies is
// kept.
void write_sheets(const FolderOptions &o, const CorrectedPictures &pictures, Ledger &ledger, Events &events);

}  // namespace lensprof
