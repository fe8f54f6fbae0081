// The corrected copies of a folder's pictures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "photo/correct/correction.hpp"
#include "photo/folder/panoramas.hpp"

namespace lensprof {

// A picture corrected by this run or an earlier one.
struct CorrectedPicture {
    const InputPicture *picture;
    std::string panorama;      // its name; "" if a profile of the databases was used
    std::optional<double> ev;  // relative to the mean of the panorama, to which it was matched
    std::string key;           // of the copy
    Correction job;
    SmallCopies small{};  // empty if it was corrected by an earlier run, or not among the first of very many
};

struct CorrectedPictures {
    std::vector<CorrectedPicture> list;  // sorted by name
    std::vector<LeftOutPicture> left_out;
    uint32_t written = 0;  // by this run
};

// How each picture is corrected: with the project of its panorama, as `apply --pto` does, else with a looked-up
// profile, as `apply` does.
CorrectedPictures plan_corrections(const FolderOptions &o, const Inputs &inputs, const Panoramas &panoramas);

// Small copies of a picture, the same whether this run corrected it or an earlier one. `pictures`: their number.
// Failure.
SmallCopies small_copies_of(const CorrectedPicture &picture, size_t pictures);

// Writes the copies missing from the ledger. A picture that cannot be corrected is left out. Throws ForeignFile, before
// the first copy is written, if a copy was modified by somebody and its correction has changed.
void write_corrections(const FolderOptions &o, CorrectedPictures &pictures, Ledger &ledger, Events &events);

}  // namespace lensprof
