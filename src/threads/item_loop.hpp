// The same work on many items, on several threads that are gone when the call returns.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace lensprof {

// `wanted`, or for 0 the number of cores; at least 1.
inline uint32_t thread_count(uint32_t wanted) {
    return wanted ? wanted : std::max(std::thread::hardware_concurrency(), 1u);
}

// Runs run(t) for every t below `threads` at once; t = 0 is the calling thread. Where the system gives fewer threads,
// the last ones are not run. `run` must not throw.
template <class Run>
void run_on_threads(uint32_t threads, const Run &run) {
    std::vector<std::thread> others;
    try {
        for (uint32_t t = 1; t < threads; t++) others.emplace_back(run, t);
    } catch (const std::exception &) {
        // No more threads to be had: those there are do the work.
    }
    run(0);
    for (auto &thread : others) thread.join();
}

// Calls work(item, thread) for every item below `count`, on at most `threads` threads; thread 0 is the calling one.
// Items are taken by rising number, and none after a call has returned false or thrown: all items below one that was
// begun are begun, too. Returns whether all calls returned true; throws what the lowest of the items that failed has
// thrown.
template <class Work>
bool for_each_item(uint32_t count, uint32_t threads, const Work &work) {
    std::atomic<uint32_t> next{0};
    std::atomic<bool> ended{false};
    std::mutex mutex;  // of the two below
    std::exception_ptr failure;
    uint32_t failed = count;
    run_on_threads(std::min(threads, count), [&](uint32_t thread) {
        while (!ended) {  // looked at before an item is taken: one that is taken is begun
            const uint32_t item = next++;
            if (item >= count) break;
            try {
                if (!work(item, thread)) ended = true;
            } catch (...) {
                ended = true;
                std::lock_guard<std::mutex> lock(mutex);
                if (item < failed) {
                    failed = item;
                    failure = std::current_exception();
                }
            }
        }
    });
    if (failure) std::rethrow_exception(failure);
    return !ended;
}

}  // namespace lensprof
