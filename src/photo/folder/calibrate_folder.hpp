// The whole job of a folder: finds, fits, stores and corrects all its panoramas, and the other pictures by databases.
#pragma once

#include <string>
#include <vector>

#include "photo/folder/corrections.hpp"

namespace lensprof {

struct FolderResult {
    Inputs inputs;  // referred to by the next two
    Panoramas panoramas;
    CorrectedPictures pictures;
    Json summary;  // docs/json.md, calibrate.json; a run that found everything done gives the same
    bool is_stored = false;
};

// Failure if the output folder or the database cannot be used; a picture or panorama that fails is a part of the
// result.
FolderResult calibrate_folder(const FolderOptions &o, Events &events);

// Those of the inputs and those of the corrections, sorted.
std::vector<LeftOutPicture> all_left_out(const Inputs &inputs, const CorrectedPictures &pictures);

// The text for a result in which nothing is corrected.
std::string nothing_corrected(const FolderOptions &o, const Inputs &inputs);

}  // namespace lensprof
