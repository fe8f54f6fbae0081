#include "parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

#include "interrupt.hpp"

namespace lensprof {

void for_each_parallel(uint32_t count, const std::string &what, Progress &progress,
                       const std::function<void(uint32_t)> &work) {
    std::vector<std::exception_ptr> failures(count);
    std::atomic<uint32_t> next{0}, done{0};
    auto run = [&] {
        for (uint32_t i = next++; i < count; i = next++) {
            try {
                stop_if_interrupted();
                work(i);
            } catch (...) {
                failures[i] = std::current_exception();
                next = count;
            }
            progress.update(what, static_cast<double>(++done) / count);
        }
    };
    std::vector<std::thread> threads;
    try {
        for (uint32_t t = 1; t < std::min(std::max(std::thread::hardware_concurrency(), 1u), count); t++)
            threads.emplace_back(run);
    } catch (const std::system_error &) {
        /* no more threads to be had: those there are do the work */
    }
    run();
    for (auto &thread : threads) thread.join();
    for (const auto &failure : failures)
        if (failure) std::rethrow_exception(failure);
}

}  // namespace lensprof
