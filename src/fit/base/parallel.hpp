// Parallel loops. All threads have ended when the call returns.
#pragma once

#include <cstdint>
#include <functional>

namespace lensprof {

// Thrown if the caller's progress function asks to stop.
struct Cancelled {};

// Calls work(i) for every i below `count` on at most `threads` threads (0 = one per core), including the calling one.
// Only the calling thread calls `stop`, after each of its own items; once it returns true, no further item starts and
// the result is false. Exceptions of `work` propagate to the caller.
bool for_each_parallel(uint32_t count, uint32_t threads, const std::function<void(uint32_t)> &work,
                       const std::function<bool()> &stop);

}  // namespace lensprof
