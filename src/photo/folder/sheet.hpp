// Small copies of the pictures, and mosaics and contact sheets of them.
#pragma once

#include "photo/folder/corrections.hpp"

namespace lensprof {

// The picture and its corrected copy, rotated as an EXIF orientation states; read if this run did not keep them. One is
// empty if its file cannot be read, because it may have been edited since.
SmallCopies small_copies(const CorrectedPicture &picture, uint16_t orientation, uint32_t side);

// calibrate_sheet.jpg and, if one page is not enough, calibrate_sheet2.jpg and so on.
std::vector<std::string> sheet_names(const FolderOptions &o, size_t pictures);

// Draws the mosaic of each panorama of its corrected copies. One that the ledger lists with the same project is kept.
void write_mosaics(Panoramas &panoramas, const CorrectedPictures &pictures, Ledger &ledger, Events &events);

// Writes the sheets, with name and exposure of each picture. A sheet that the ledger lists with the same copies is
// kept.
void write_sheets(const FolderOptions &o, const CorrectedPictures &pictures, Ledger &ledger, Events &events);

}  // namespace lensprof
