#include "cli/program/exit_code.hpp"

#include "photo/base/failure.hpp"

namespace lensprof {

ExitCode exit_code(lensprof_status status) {
    switch (group_of(status)) {
    case LENSPROF_OK: return ExitCode::done;
    case LENSPROF_ERROR_ARGUMENT: return ExitCode::usage;
    case LENSPROF_ERROR_READ: return ExitCode::unreadable;
    case LENSPROF_ERROR_NOT_USABLE: return ExitCode::not_usable;
    case LENSPROF_ERROR_NOT_FOUND: return ExitCode::not_found;
    case LENSPROF_ERROR_STORE: return ExitCode::store;
    case LENSPROF_ERROR_CANCELLED: return ExitCode::interrupted;
    default: return ExitCode::failed;
    }
}

}  // namespace lensprof
