// Values that no exposure change can restore.
#pragma once

#include <string>

#include "photo/pictures/picture.hpp"

namespace lensprof {

// Share of pixels that are white (above 250 of 255) in some channel.
double white_share(const Picture &picture);

}  // namespace lensprof
