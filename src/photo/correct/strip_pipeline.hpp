// One thread produces items that another consumes, a few items ahead.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace lensprof {

// Items that circulate between two threads: empty to the producer, full to the consumer, in order. Neither side waits
// forever: a side that ends signals it.
template <class Item>
class StripRing {
public:
    explicit StripRing(size_t items) : items_(items) {}

    // The next empty item; NULL if the consumer has stopped.
    Item *empty() {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [&] { return made_ - taken_ < items_.size() || given_up_; });
        return given_up_ ? nullptr : &items_[made_ % items_.size()];
    }

    // The next full item; NULL if there will be no more.
    Item *full() {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [&] { return made_ > taken_ || ended_; });
        return made_ > taken_ ? &items_[taken_ % items_.size()] : nullptr;
    }

    void filled() {
        change([&] { made_++; });
    }
    void emptied() {
        change([&] { taken_++; });
    }
    void end() {
        change([&] { ended_ = true; });
    }
    void give_up() {
        change([&] { given_up_ = true; });
    }

private:
    template <class Change>
    void change(const Change &what) {
        {
            std::lock_guard<std::mutex> lock(mutex_);
            what();
        }
        changed_.notify_all();
    }

    std::vector<Item> items_;
    size_t made_ = 0, taken_ = 0;
    bool ended_ = false, given_up_ = false;
    std::mutex mutex_;
    std::condition_variable changed_;
};

// Calls make(item), on another thread if `split`, until it returns false, and take(item) for every item in order.
// Throws the exception of whichever failed first in the order of the items.
template <class Item, class Make, class Take>
void make_and_take(bool split, const Make &make, const Take &take) {
    StripRing<Item> ring(split ? 3 : 1);
    std::exception_ptr failure;
    std::thread maker;
    auto run = [&, events = CallerScope::of_thread()] {
        CallerScope caller(events);
        try {
            for (Item *item = ring.empty(); item && make(*item); item = ring.empty()) ring.filled();
        } catch (...) {
            failure = std::current_exception();
        }
        ring.end();
    };
    try {
        if (split) maker = std::thread(run);
    } catch (const std::system_error &) {
        // no thread available
    }
    if (!maker.joinable()) {
        for (Item *item = ring.empty(); make(*item);) take(*item);
        return;
    }
    try {
        for (Item *item = ring.full(); item; item = ring.full()) {
            take(*item);
            ring.emptied();
        }
    } catch (...) {
        ring.give_up();
        maker.join();
        throw;
    }
    maker.join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace lensprof
