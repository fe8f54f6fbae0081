#include "cli/program/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "cli/program/interrupt.hpp"

namespace lensprof {
namespace {

// Runs the same on several threads, this one among them.
void run_on_threads(uint32_t threads, const std::function<void()> &run) {
    std::vector<std::thread> others;
    try {
        for (uint32_t t = 1; t < threads; t++) others.emplace_back(run);
    } catch (const std::system_error &) {
        // no more threads to be had: those there are do the work
    }
    run();
    for (auto &thread : others) thread.join();
}

void throw_first(const std::vector<std::exception_ptr> &failures) {
    for (const auto &failure : failures)
        if (failure) std::rethrow_exception(failure);
}

// Items whose work is done, and which of them are finished.
class Finishing {
public:
    Finishing(uint32_t count, const std::function<void(uint32_t)> &finish) : worked_(count), finish_(finish) {}

    // Item i was worked on: finishes what can be, unless another thread is about it. Returns the first item that could
    // not be finished and sets `failure`, else the number of items.
    uint32_t add(uint32_t i, std::exception_ptr &failure) {
        std::unique_lock<std::mutex> lock(mutex_);
        worked_[i] = true;
        if (busy_) return size();
        busy_ = true;
        for (; next_ < size() && worked_[next_]; next_++) {
            lock.unlock();
            try {
                stop_if_interrupted();
                finish_(next_);
            } catch (...) {
                failure = std::current_exception();
                return next_;  // and stays busy: nothing is finished any more
            }
            lock.lock();
        }
        busy_ = false;
        return size();
    }

private:
    uint32_t size() const { return static_cast<uint32_t>(worked_.size()); }

    std::mutex mutex_;
    std::vector<bool> worked_;
    const std::function<void(uint32_t)> &finish_;
    uint32_t next_ = 0;  // written by the thread that is busy
    bool busy_ = false;
};

}  // namespace

uint32_t thread_count(uint32_t wanted) { return wanted ? wanted : std::max(std::thread::hardware_concurrency(), 1u); }

void for_each_parallel(uint32_t count, const std::string &what, Progress &progress,
                       const std::function<void(uint32_t)> &work) {
    std::atomic<uint32_t> done{0};
    for_each_in_order(
        count, thread_count(0),
        [&](uint32_t i) {
            work(i);
            progress.update(what, static_cast<double>(++done) / count);
        },
        [](uint32_t) {});
}

void for_each_in_order(uint32_t count, uint32_t threads, const std::function<void(uint32_t)> &work,
                       const std::function<void(uint32_t)> &finish) {
    std::vector<std::exception_ptr> failures(count);
    std::atomic<uint32_t> next{0};
    Finishing finishing(count, finish);
    run_on_threads(std::min(threads, count), [&] {
        for (uint32_t i = next++; i < count; i = next++) {
            try {
                stop_if_interrupted();
                work(i);
                std::exception_ptr failure;
                uint32_t unfinished = finishing.add(i, failure);
                if (failure) {
                    failures[unfinished] = failure;
                    next = count;
                }
            } catch (...) {
                failures[i] = std::current_exception();
                next = count;
            }
        }
    });
    throw_first(failures);
}

}  // namespace lensprof
