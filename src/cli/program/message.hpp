// Messages on standard error.
#pragma once

#include <string>

#include "cli/program/run.hpp"

namespace lensprof {

// Prints one line that starts with "lensprof: ", "lensprof: warning: " or "lensprof: note: "; --quiet omits warnings
// and notes. File names and EXIF may contain anything: control characters are escaped. "warning:" and "note:" have a
// colour on a terminal, unless NO_COLOR is set (https://no-color.org).
void print_message(Streams &streams, const std::string &text);
void warn(Streams &streams, const std::string &text);
void note(Streams &streams, const std::string &text);

// Whether standard error is a terminal that shows colours.
bool shows_colour();

// A command line for a shell: "lensprof" and the words, those in quotes that need them.
std::string command_text(const std::vector<std::string> &words);

}  // namespace lensprof
