// The option --db of commands that read databases.
#pragma once

#include <string>
#include <vector>

#include "cli/program/options.hpp"
#include "photo/base/databases.hpp"

namespace lensprof {

// Declares --db FILE, repeatable.
void declare_databases(Command &command, std::vector<std::string> &files, const std::string &more = "");

// The same for commands that list the content of all of them.
void declare_listed_databases(Command &command, std::vector<std::string> &files, const std::string &more = "");

}  // namespace lensprof
