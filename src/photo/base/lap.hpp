#pragma once

#include <chrono>

namespace lensprof {

// Seconds since `since`, which becomes now.
inline double lap(std::chrono::steady_clock::time_point &since) {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - since).count();
    since = now;
    return seconds;
}

}  // namespace lensprof
