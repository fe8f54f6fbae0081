// Contact sheets whose pictures are named.
#pragma once

#include "cli/calibrate/corrections.hpp"

namespace lensprof {

// The sheets of these pictures: calibrate_sheet.jpg and, of more than a page holds, calibrate_sheet2.jpg and so on.
std::vector<std::string> sheet_names(const CalibrateOptions &o, size_t pictures);

// Every picture before and below it after, the right way up by EXIF's orientation, with its name and exposure. A sheet
// that the ledger has of the same copies is left as it is.
void write_sheets(const CalibrateOptions &o, const CorrectedPictures &pictures, Ledger &ledger, Progress &progress);

}  // namespace lensprof
