// Warnings for exposures that pictures cannot take.
#pragma once

#include <string>

#include "cli/program/run.hpp"

namespace lensprof {

// Warns if changing a frame from its own to the wanted exposure turns white to grey or amplifies the noise of dark
// areas.
void warn_of_limits(const std::string &file, double own_ev, double wanted_ev, double white_share, Streams &streams);

}  // namespace lensprof
