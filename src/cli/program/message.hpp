// What people are told on standard error while a command runs.
#pragma once

#include <string>

#include "cli/program/run.hpp"

namespace lensprof {

// One line that begins with "lensprof: ", with "lensprof: warning: " and "lensprof: note: ". Names of files and EXIF
// may hold anything: control characters do not reach the terminal.
void tell(Streams &streams, const std::string &text);
void warn(Streams &streams, const std::string &text);
void note(Streams &streams, const std::string &text);

// A command line for a shell: "lensprof" and the words, those in quotes that need them.
std::string command_text(const std::vector<std::string> &words);

}  // namespace lensprof
