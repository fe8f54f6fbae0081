// `lensprof completion` and `lensprof man`: for shells and for man.
#pragma once

#include "cli/program/options.hpp"

namespace lensprof {

void declare_completion(Command &root, const Program &program);
void declare_man(Command &root, const Program &program);

}  // namespace lensprof
