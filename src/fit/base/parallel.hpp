// The same work on many items, on several threads that are gone when the call returns.
#pragma once

#include <cstdint>
#include <functional>

namespace lensprof {

// Thrown where the caller's progress function asks to stop.
struct Cancelled {};

// Calls work(i) for every i below `count` on at most `threads` threads (0 = one a core), the calling one among them.
// `stop` is asked by the calling thread only, after each of its own items; once it says true no item is begun and the
// result is false. What `work` throws comes out of here.
bool for_each_parallel(uint32_t count, uint32_t threads, const std::function<void(uint32_t)> &work,
                       const std::function<bool()> &stop);

}  // namespace lensprof
