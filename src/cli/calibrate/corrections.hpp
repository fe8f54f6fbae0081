// The corrected copies of a folder's pictures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/calibrate/panoramas.hpp"
#include "cli/correct/correction.hpp"

namespace lensprof {

// One picture that is corrected, by this run or an earlier one.
struct CorrectedPicture {
    const InputPicture *picture;
    std::string panorama;      // its name; "" where a profile of the databases was taken
    std::optional<double> ev;  // beside the mean of the panorama, which it was made like
    std::string key;           // of the copy
    Correction job;
};

struct CorrectedPictures {
    std::vector<CorrectedPicture> list;  // by name
    std::vector<LeftOutPicture> left_out;
    uint32_t written = 0;  // by this run
};

// What each picture is corrected with: the project of its panorama, as `apply --pto`, else a profile that a lookup
// finds, as `apply`.
CorrectedPictures plan_corrections(const CalibrateOptions &o, const Inputs &inputs, const Panoramas &panoramas);

// Writes the copies that the ledger does not have. A picture that cannot be corrected is left out. InTheWay, before the
// first is written, for a copy that somebody has edited and whose correction is another now.
void write_corrections(const CalibrateOptions &o, CorrectedPictures &pictures, Ledger &ledger, Progress &progress);

}  // namespace lensprof
