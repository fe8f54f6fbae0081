// Reports of profiles and of databases as web pages (cli/page).
#pragma once

#include <string>
#include <vector>

#include "photo/base/library.hpp"

namespace lensprof {

// The bytes of the page of one profile: falloff and response with their errors, and where they are from.
std::string profile_page(const StoredProfile &stored, const std::string &command);

// The bytes of the page of many: a table of lenses with a search, and falloffs over aperture (Goldman & Chen 2005,
// figure 5). `name` is that of the database or file; `warnings` are part of the verdict.
std::string database_page(const std::vector<StoredProfile> &profiles, const std::string &name,
                          const std::string &command, const std::vector<std::string> &warnings);

}  // namespace lensprof
