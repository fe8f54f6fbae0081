// The options of the command that stand for options of the photograph library.
#pragma once

#include <string>

namespace lensprof {

// "--one-lens" for "one_lens".
std::string option_of(const std::string &name);

}  // namespace lensprof
