// Words of a command line that a message shows.
#pragma once

#include <string>

namespace lensprof {

// A word for a shell, in quotes if it needs them.
std::string shell_word(const std::string &word);

}  // namespace lensprof
