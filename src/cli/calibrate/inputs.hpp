// The pictures that calibrate is given, and what is left out before anything is computed.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "cli/calibrate/ledger.hpp"
#include "cli/pictures/metadata.hpp"
#include "cli/program/progress.hpp"

namespace lensprof {

struct LeftOutPicture {
    std::string file, reason;
};

struct InputPicture {
    std::string file, name;  // name: what reports call it
    std::string target;      // its corrected copy
    std::string identity;    // changes when the file does
    bool is_raw = false;     // a camera raw file
    PictureMetadata metadata;
};

struct Inputs {
    std::string label;                   // of all
    std::vector<InputPicture> pictures;  // those that can be used
    std::vector<LeftOutPicture> left_out;
    size_t found = 0, unreadable = 0;
};

// Pictures by the words of the command line, each once, without folders that an earlier calibrate has written. Left out
// are copies, files that cannot be read, what lensprof has corrected, and of pictures of one folder that would have one
// corrected copy all but the first; subfolders that cannot be listed are named there, too. Failure (usage) where
// `output` is one of the folders, pictures of two folders would have one copy, or that would be a picture itself.
Inputs find_inputs(const std::vector<std::string> &words, const std::string &output, Progress &progress);

constexpr const char *summary_name = "calibrate.json";

// "calibrate_sheet.jpg", "calibrate_sheet2.jpg" and so on.
std::string sheet_name(size_t page);

}  // namespace lensprof
