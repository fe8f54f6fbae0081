#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include "photo/base/events.hpp"

namespace lensprof {

// Shows progress as pictures and pixels done, with their rate. Threads: all methods may be called by any thread.
class Throughput {
public:
    Throughput(Events &events, const std::string &what, uint32_t pictures, uint64_t pixels);

    void add_pixels(uint64_t pixels);
    void add_picture();

    double seconds() const;  // since the start
    double megapixels() const;

    // "40 pictures, 480.0 megapixels in 9.8 s: 4.1 pictures/s, 49.0 megapixels/s"
    std::string summary() const;

private:
    void show();

    Events &events_;
    const std::string what_;
    const uint32_t pictures_;
    const uint64_t pixels_;
    const std::chrono::steady_clock::time_point begin_;
    mutable std::mutex mutex_;
    uint32_t pictures_done_ = 0;
    uint64_t pixels_done_ = 0;
};

}  // namespace lensprof
