// The exception of the photograph library.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include <lensprof/base.h>
#include <lensprof/reason.h>

namespace lensprof {

// One status for all statuses of a kind: ARGUMENT, READ (an input cannot be read), NOT_USABLE (a fit ran,
// but its result must not be used), NOT_FOUND (no such profile), STORE (the profile database), CANCELLED; WRITE for
// everything else.
lensprof_status group_of(lensprof_status status);

// what() is a complete message for the user: the item, what is wrong, and the next step.
struct Failure : std::runtime_error {
    Failure(lensprof_status of, const std::string &text, uint32_t reason_code = LENSPROF_REASON_NONE)
        : std::runtime_error(text), status(of), reason(reason_code) {}

    lensprof_status group() const { return group_of(status); }

    lensprof_status status;
    uint32_t reason;  // lensprof_reason of a result that is not usable
};

// Whether the cause is one of the inputs, so that the others may still be processed. False if it is the disk, the
// database or a cancellation.
inline bool is_of_input(const Failure &failure) {
    const lensprof_status group = failure.group();
    return group == LENSPROF_ERROR_ARGUMENT || group == LENSPROF_ERROR_READ || group == LENSPROF_ERROR_NOT_USABLE
           || group == LENSPROF_ERROR_NOT_FOUND;
}

}  // namespace lensprof
