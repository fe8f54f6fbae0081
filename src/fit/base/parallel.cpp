#include "fit/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace lensprof {

constexpr uint32_t kMostThreads = 256;

bool for_each_parallel(uint32_t count, uint32_t threads, const std::function<void(uint32_t)> &work,
                       const std::function<bool()> &stop) {
    const uint32_t wanted = threads ? threads : std::max(std::thread::hardware_concurrency(), 1u);
    const uint32_t used = std::max(std::min({wanted, count, kMostThreads}), 1u);
    std::atomic<uint32_t> next{0};
    std::atomic<bool> ended{false};
    std::vector<std::exception_ptr> failures(used);
    bool stopped = false;  // of the calling thread
    auto run = [&](uint32_t thread) {
        try {
            for (uint32_t i = next++; i < count && !ended; i = next++) {
                work(i);
                if (thread == 0 && stop()) ended = stopped = true;
            }
        } catch (...) {
            failures[thread] = std::current_exception();
            ended = true;
        }
    };
    std::vector<std::thread> others;
    try {
        others.reserve(used);
        for (uint32_t t = 1; t < used; t++) others.emplace_back(run, t);
    } catch (const std::exception &) {
        // No more threads to be had: those there are do the work.
    }
    run(0);
    for (auto &thread : others) thread.join();
    if (!ended && stop()) stopped = true;  // also where the other threads did all of it
    for (const auto &failure : failures)
        if (failure) std::rethrow_exception(failure);
    return !stopped;
}

}  // namespace lensprof
