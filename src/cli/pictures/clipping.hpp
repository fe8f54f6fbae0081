// Warnings for values that no exposure change can restore.
#pragma once

#include <string>

#include "cli/pictures/picture.hpp"
#include "cli/program/run.hpp"

namespace lensprof {

// Share of pixels that are white (above 250 of 255) in some channel.
double white_share(const Picture &picture);

// Warns if changing a frame from its own to the wanted exposure turns white to grey or amplifies the noise of dark
// areas.
void warn_of_limits(const std::string &file, double own_ev, double wanted_ev, double white_share, Streams &streams);

}  // namespace lensprof
