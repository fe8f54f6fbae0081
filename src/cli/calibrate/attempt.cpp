#include "cli/calibrate/attempt.hpp"

#include "cli/calibrate/ledger.hpp"

namespace lensprof {

bool is_of_pictures(const Failure &failure) {
    if (dynamic_cast<const ForeignFile *>(&failure)) return false;
    return failure.code == ExitCode::usage || failure.code == ExitCode::unreadable
           || failure.code == ExitCode::not_usable || failure.code == ExitCode::not_found;
}

std::string failure_of(const std::function<void()> &step) {
    try {
        step();
        return {};
    } catch (const Failure &failure) {
        if (!is_of_pictures(failure)) throw;
        return failure.what();
    }
}

}  // namespace lensprof
