#include "photo/base/parallel.hpp"

#include <atomic>
#include <exception>
#include <mutex>
#include <vector>

namespace lensprof {
namespace {

// Items whose work is done, and those finished.
class Finishing {
public:
    Finishing(uint32_t count, const std::function<void(uint32_t)> &finish) : worked_(count), finish_(finish) {}

    // Marks item i as done and finishes all possible items, unless another thread is doing so. False after a failure;
    // then nothing more is finished.
    bool add(uint32_t i) {
        std::unique_lock<std::mutex> lock(mutex_);
        worked_[i] = true;
        if (busy_) return true;
        busy_ = true;
        for (; next_ < worked_.size() && worked_[next_]; next_++) {
            lock.unlock();
            try {
                stop_if_cancelled();
                finish_(next_);
            } catch (...) {
                failure_ = std::current_exception();
                return false;  // and stays busy
            }
            lock.lock();
        }
        busy_ = false;
        return true;
    }

    // Call when all threads have ended.
    void throw_failure() const {
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    std::mutex mutex_;
    std::vector<bool> worked_;
    const std::function<void(uint32_t)> &finish_;
    uint32_t next_ = 0;           // written by the finishing thread
    std::exception_ptr failure_;  // of finishing item next_
    bool busy_ = false;
};

}  // namespace

void for_each_parallel(uint32_t count, const std::string &what, Events &events,
                       const std::function<void(uint32_t)> &work) {
    std::atomic<uint32_t> done{0};
    for_each_in_order(
        count, thread_count(0),
        [&](uint32_t i) {
            work(i);
            events.update_items(what, ++done, count);
        },
        [](uint32_t) {});
}

void for_each_in_order(uint32_t count, uint32_t threads, const std::function<void(uint32_t)> &work,
                       const std::function<void(uint32_t)> &finish) {
    Finishing finishing(count, finish);
    try {
        for_each_item(count, threads, [&, events = CallerScope::of_thread()](uint32_t i, uint32_t) {
            CallerScope caller(events);
            stop_if_cancelled();
            work(i);
            return finishing.add(i);
        });
    } catch (...) {
        finishing.throw_failure();  // of a lower item: all below it were done without failure
        throw;
    }
    finishing.throw_failure();
}

}  // namespace lensprof
