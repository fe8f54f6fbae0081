/* foreign_options.hpp - the options of `profile import` and `profile export` that say what files do not. */
#ifndef LENSPROF_CLI_FOREIGN_OPTIONS_HPP
#define LENSPROF_CLI_FOREIGN_OPTIONS_HPP

#include <CLI/CLI.hpp>

#include "foreign_file.hpp"

namespace lensprof {

/* `options` outlives the parsing. */
void declare_foreign(CLI::App &app, ForeignOptions &options, bool written);

}  // namespace lensprof

#endif
