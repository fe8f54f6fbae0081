// Parallel loops over items.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "photo/base/events.hpp"
#include "threads/item_loop.hpp"

namespace lensprof {

// Calls work(i) for every i below count in parallel and shows progress labelled `what`. After a failure or interrupt no
// new item is started; the failure of the lowest item is thrown, regardless of timing.
void for_each_parallel(uint32_t count, const std::string &what, Events &events,
                       const std::function<void(uint32_t)> &work);

// Calls work(i) for every i below count on up to `threads` threads, and then finish(i): in the order of the items, one
// at a time, on any of the threads. After a failure exactly the items below the failed one are finished, as with one
// thread; the failure of the lowest item is thrown.
void for_each_in_order(uint32_t count, uint32_t threads, const std::function<void(uint32_t)> &work,
                       const std::function<void(uint32_t)> &finish);

}  // namespace lensprof
