// The options of `profile import` and `profile export` that say what files do not.
#pragma once

#include "cli/profiles/foreign_file.hpp"

namespace CLI {
class App;
}

namespace lensprof {

// `options` outlives the parsing.
void declare_foreign(CLI::App &app, ForeignOptions &options, bool written);

}  // namespace lensprof
