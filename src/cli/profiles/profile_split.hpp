// `lensprof profile export --split`: writes one file per lens into a folder.
#pragma once

#include <string>
#include <vector>

#include "cli/profiles/foreign_file.hpp"
#include "photo/calibration/key_filter.hpp"

namespace lensprof {

// A written file, and its profiles.
struct SplitFile {
    std::string path;
    std::vector<const StoredProfile *> profiles;
};

// Writes the profiles to the folder, which is created if missing: one file per lens or, if the format holds only one
// profile, per profile. All files or none. Failure with the file name.
std::vector<SplitFile> write_split(const ForeignRule &rule, const std::string &folder, const ForeignOptions &options,
                                   const std::vector<StoredProfile> &profiles);

}  // namespace lensprof
