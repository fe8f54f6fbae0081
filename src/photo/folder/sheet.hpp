// Small copies of the pictures, and mosaics and contact sheets of them.
#pragma once

#include "photo/folder/corrections.hpp"

namespace lensprof {

// Picture `index` before and after correction, rotated as an EXIF orientation states; corrected again if this run did
// not keep them. Empty if its file cannot be read any more.
SmallCopies small_copies(const CorrectedPictures &pictures, size_t index, uint16_t orientation, uint32_t side);

// calibrate_sheet.jpg and, if one page is not enough, calibrate_sheet2.jpg and so on.
std::vector<std::string> sheet_names(const FolderOptions &o, size_t pictures);

// Draws the mosaic of each panorama of its corrected copies. One that the ledger lists with the same project is kept.
void write_mosaics(Panoramas &panoramas, const CorrectedPictures &pictures, Ledger &ledger, Events &events);

// Writes the sheets, with name and exposure of each picture. A sheet that the ledger lists with the same copies is
// kept.
void write_sheets(const FolderOptions &o, const CorrectedPictures &pictures, Ledger &ledger, Events &events);

}  // namespace lensprof
