// What the command calls the options of the photograph library.
#pragma once

#include <string>

namespace lensprof {

// "--one-lens" for "one_lens".
std::string option_of(const std::string &name);

// The commands that help in a situation that the library reports, as the rest of its sentence; empty without any.
std::string advice_for(const std::string &situation);

}  // namespace lensprof
