// Sensor sizes from a database's table of cameras.
#pragma once

#include <string>

#include "photo/base/databases.hpp"
#include "photo/pictures/metadata.hpp"

namespace lensprof {

// The crop factor of the key's camera, for the part of its frame that the picture shows; for a camera whose picture
// formats use different sensor areas, that of the picture's format. LENSPROF_UNKNOWN if the table does not list it.
// Throws Failure.
double crop_factor_in_table(lensprof_store *store, const lensprof_profile_key &key, PictureSize picture);

// From the first of several databases that lists it.
double crop_factor_in_tables(const Databases &databases, const lensprof_profile_key &key, PictureSize picture);

// The same for the databases of --db (databases_of), which may be missing; errors in them are reported elsewhere.
double crop_factor_in_files(const std::vector<std::string> &named, const lensprof_profile_key &key,
                            PictureSize picture);

}  // namespace lensprof
