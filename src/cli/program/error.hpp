// The exception type of the command line program.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include <lensprof/reason.h>

namespace lensprof {

// Exit codes of the process. Scripts depend on the numbers: never change them.
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

// what() is a complete message for the user: the item, what is wrong, and the next step.
struct Failure : std::runtime_error {
    Failure(ExitCode exit_code, const std::string &text, uint32_t reason_code = LENSPROF_REASON_NONE)
        : std::runtime_error(text), code(exit_code), reason(reason_code) {}

    ExitCode code;
    uint32_t reason;  // lensprof_reason of a result that is not usable
};

// Whether the cause is one of the inputs, so that the others may still be processed. False if it is the disk, the
// database or an interrupt.
inline bool is_of_input(const Failure &failure) {
    return failure.code == ExitCode::usage || failure.code == ExitCode::unreadable
           || failure.code == ExitCode::not_usable || failure.code == ExitCode::not_found;
}

}  // namespace lensprof
