// `lensprof profile export --split`: a folder with a file for each lens.
#pragma once

#include <string>
#include <vector>

#include "cli/profiles/foreign_file.hpp"
#include "cli/profiles/key_filter.hpp"

namespace lensprof {

// A file that was written, and the profiles in it.
struct SplitFile {
    std::string path;
    std::vector<const StoredProfile *> profiles;
};

// Writes the profiles to the folder, made where there is none: a file for each lens, or, in a format of one profile,
// for each profile. All of the files or none. Failure names the file.
std::vector<SplitFile> write_split(const ForeignRule &rule, const std::string &folder, const ForeignOptions &options,
                                   const std::vector<StoredProfile> &profiles);

}  // namespace lensprof
