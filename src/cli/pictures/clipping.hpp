// What a sensor did not record cannot be made like another exposure.
#pragma once

#include <string>

#include "cli/pictures/picture.hpp"
#include "cli/program/run.hpp"

namespace lensprof {

// Share of the pixels that are white (above 250 of 255) in some channel.
double white_share(const Picture &picture);

// Warns of what no exposure brings back when a frame changes from its own exposure to the wanted one: white that
// becomes grey, and noise of what was dark.
void warn_of_limits(const std::string &file, double own_ev, double wanted_ev, double white_share, Streams &streams);

}  // namespace lensprof
