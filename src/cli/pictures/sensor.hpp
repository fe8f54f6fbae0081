// How large a picture's sensor is, by a database's table of cameras.
#pragma once

#include <string>

#include "cli/pictures/metadata.hpp"
#include "cli/program/databases.hpp"

namespace lensprof {

// The crop factor of the key's camera; of a camera whose picture formats have sensor sizes of their own that of the
// picture's format. LENSPROF_UNKNOWN where the table does not tell. Throws Failure.
double crop_factor_in_table(lensprof_store *store, const lensprof_profile_key &key, PictureSize picture);

// By the first of several databases that tells.
double crop_factor_in_tables(const Databases &databases, const lensprof_profile_key &key, PictureSize picture);

// As before, of the databases that --db names (databases_of), which need not be there; what is wrong with them is left
// to others to say.
double crop_factor_in_files(const std::vector<std::string> &named, const lensprof_profile_key &key,
                            PictureSize picture);

}  // namespace lensprof
