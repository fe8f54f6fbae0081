// The input pictures of calibrate, and those left out before anything is computed.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/folder/ledger.hpp"
#include "photo/pictures/metadata.hpp"

namespace lensprof {

struct LeftOutPicture {
    std::string file, reason;
};

struct InputPicture {
    std::string file, name;  // name: the name used in reports
    std::string target;      // its corrected copy
    std::string identity;    // changes whenever the file changes
    bool is_raw = false;     // whether it is a camera raw file
    PictureMetadata metadata;
};

struct Inputs {
    std::string label;                   // number of all pictures
    std::vector<InputPicture> pictures;  // the usable pictures
    std::vector<LeftOutPicture> left_out;
    size_t found = 0, unreadable = 0;
};

// Resolves the words of the command line to pictures, each listed once; folders written by an earlier calibrate are
// skipped. Left out are copies, unreadable files, pictures already corrected by lensprof, and all but the first of the
// pictures of one folder that would share one corrected copy; subfolders that cannot be listed are reported in the same
// list. Failure (usage) if `output` is one of the input folders, if pictures of two folders would share one copy, or if
// a copy would overwrite an input.
Inputs find_inputs(const std::vector<std::string> &words, const std::string &output, Events &events);

constexpr const char *summary_name = "calibrate.json";

// "calibrate_sheet.jpg", "calibrate_sheet2.jpg" and so on.
std::string sheet_name(size_t page);

}  // namespace lensprof
