// The same work on many items, on all cores.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "cli/program/progress.hpp"
#include "threads/item_loop.hpp"

namespace lensprof {

// Calls work(i) for every i below count, several at once, and shows progress as `what`. After a failure or an interrupt
// no new item is begun; the failure of the lowest item is thrown, whatever the timing.
void for_each_parallel(uint32_t count, const std::string &what, Progress &progress,
                       const std::function<void(uint32_t)> &work);

// Calls work(i) for every i below count, on up to `threads` threads, and after it finish(i): in the order of the items,
// one at a time, by any of the threads. What is finished when something fails are the items below the one that
// failed, as if there were one thread; the failure of the lowest item is thrown.
void for_each_in_order(uint32_t count, uint32_t threads, const std::function<void(uint32_t)> &work,
                       const std::function<void(uint32_t)> &finish);

}  // namespace lensprof
