// Profiles as a file for Lensfun, with mount and crop factor of their cameras.
#pragma once

#include <string>
#include <vector>

#include "photo/base/library.hpp"

namespace lensprof {

// What is lost in the file.
struct LensFileCost {
    std::vector<double> ev;                    // one per profile: cost_ev of lensprof_export_options
    std::vector<std::string> unknown_cameras;  // not in the table of cameras: mount and crop factor by name and profile
};

// What a user should know of it: cameras that are unknown, and costs that can be seen. `names`: of the profiles.
std::vector<std::string> notes_of(const LensFileCost &cost, const std::vector<std::string> &names);

// That files of other programs do not hold the black and white level of a profile, or its image circle; empty without
// one. `name`: of the profile.
std::string note_of_levels(const lensprof_profile &profile, const std::string &name);
std::string note_of_circle(const lensprof_profile &profile, const std::string &name);

// The text of a Lensfun database: that of the file `into` with the profiles added, or a new one where that is empty.
// Cameras are looked up in `dbs`, by default the user's own database, and in the installed one. `names` are those of
// the profiles in a Failure.
std::string lens_file_text(const std::vector<const lensprof_profile *> &profiles, const std::vector<std::string> &dbs,
                           const std::string &into, LensFileCost &cost, const std::vector<std::string> &names = {});

}  // namespace lensprof
