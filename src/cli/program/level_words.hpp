// Black and white levels as words of options: 256 (a value of the samples) or 6% (of full scale).
#pragma once

#include <string>

#include "photo/pictures/stated_levels.hpp"

namespace lensprof {

// "256", "6%" or "256:250:260" (red, green, blue). Throws std::invalid_argument with the reason: also for a share
// without a sign.
std::vector<StatedLevel> black_levels_of(const std::string &word);

StatedLevel white_level_of(const std::string &word);

}  // namespace lensprof
