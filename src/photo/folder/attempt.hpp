// Keeps one bad picture from stopping the whole job.
#pragma once

#include <functional>
#include <string>

#include "photo/base/failure.hpp"

namespace lensprof {

// Whether other steps may still succeed. False if the cause is the disk, the database, an interrupt or a file in the
// way.
bool is_of_pictures(const Failure &failure);

// Returns "" if the step succeeded, else the reason. Rethrows a Failure that does not concern pictures.
std::string failure_of(const std::function<void()> &step);

}  // namespace lensprof
