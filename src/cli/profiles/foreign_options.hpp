// The options of `profile import` and `profile export` for information that files do not contain.
#pragma once

#include "cli/profiles/foreign_file.hpp"
#include "cli/program/options.hpp"

namespace lensprof {

// Declares --encoding, whose further keys are declared with what this returns.
Keys declare_foreign(Command &command, ForeignOptions &options, bool is_output);

// The choices of --format.
Choices<std::string> format_choices(bool to_write);

}  // namespace lensprof
