// Contact sheets with picture names.
#pragma once

#include "cli/calibrate/corrections.hpp"

namespace lensprof {

// Writes the sheets of these pictures: calibrate_sheet.jpg and, if one page is not enough, calibrate_sheet2.jpg and so
// on. Each picture is shown before and, below, after correction, upright according to EXIF, with name and exposure. A
// sheet is kept if the ledger lists it with the same copies.
std::vector<std::string> sheet_names(const CalibrateOptions &o, size_t pictures);

// Every picture before and below it after, the right way up by EXIF's orientation, with its name and exposure. A sheet
// that the ledger has of the same copies is left as it is.
void write_sheets(const CalibrateOptions &o, const CorrectedPictures &pictures, Ledger &ledger, Progress &progress);

}  // namespace lensprof
