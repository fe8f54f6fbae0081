// The option of a part of the work.
#pragma once

#include <string>

#include "photo/base/shard.hpp"

namespace lensprof {

// Parses "2/5"; an empty word gives the whole. Failure (usage) for the option --shard.
Shard shard_of(const std::string &word);

}  // namespace lensprof
