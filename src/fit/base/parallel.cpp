#include "fit/base/parallel.hpp"

#include <algorithm>

#include "threads/item_loop.hpp"

namespace lensprof {

constexpr uint32_t kMaxThreads = 256;

bool for_each_parallel(uint32_t count, uint32_t threads, const std::function<void(uint32_t)> &work,
                       const std::function<bool()> &stop) {
    const bool all =
        for_each_item(count, std::min(thread_count(threads), kMaxThreads), [&](uint32_t i, uint32_t thread) {
            work(i);
            return thread != 0 || !stop();
        });
    return all && !stop();  // also if the other threads did all the work
}

}  // namespace lensprof
