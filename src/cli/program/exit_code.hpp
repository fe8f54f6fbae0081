// Exit codes of the process.
#pragma once

#include <lensprof/base.h>

namespace lensprof {

// Scripts depend on the numbers: never change them.
enum class ExitCode : int {
    done = 0,
    failed = 1,
    usage = 2,
    unreadable = 3,  // an input cannot be read
    not_usable = 4,  // the fit ran, but its result must not be used
    not_found = 5,   // no such profile
    store = 6,       // the profile database
    interrupted = 130
};

// The code of a status.
ExitCode exit_code(lensprof_status status);

}  // namespace lensprof
