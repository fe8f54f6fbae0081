#include "photo/folder/attempt.hpp"

#include "photo/folder/ledger.hpp"

namespace lensprof {

bool is_of_pictures(const Failure &failure) {
    return is_of_input(failure) && !dynamic_cast<const ForeignFile *>(&failure);
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
