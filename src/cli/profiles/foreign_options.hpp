// The options of `profile import` and `profile export` that say what files do not.
#pragma once

#include "cli/profiles/foreign_file.hpp"
#include "cli/program/options.hpp"

namespace lensprof {

// `options` outlives the parsing.
void declare_foreign(Command &command, ForeignOptions &options, bool written);

// The words of --format.
Choices<std::string> format_choices(bool written_only);

}  // namespace lensprof
