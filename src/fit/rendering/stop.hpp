// Lets the caller cancel a long call.
#pragma once

#include <lensprof/base.h>

#include "fit/base/parallel.hpp"

namespace lensprof {

struct Stop {
    lensprof_progress progress = nullptr;
    void *user = nullptr;

    // Throws Cancelled if the caller asks to stop.
    void check() const {
        if (progress && progress(0.0, user) != 0) throw Cancelled{};
    }
};

}  // namespace lensprof
