// One odd picture is no reason to stop the whole job.
#pragma once

#include <functional>
#include <string>

#include "cli/program/error.hpp"

namespace lensprof {

// Whether others may go well: not where the disk, the database or an interrupt is the reason, or a file in the way.
bool is_of_pictures(const Failure &failure);

// "" where a step went well, else why not. A Failure that is not of pictures is thrown.
std::string why_not(const std::function<void()> &step);

}  // namespace lensprof
