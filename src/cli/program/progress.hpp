// A progress line on standard error; shown only on a terminal unless requested.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <ostream>
#include <string>

namespace lensprof {

enum class ShowProgress {
    when_terminal,
    always,
    never
};

// Estimates the remaining time of a task from the share done since it started.
class TimeLeft {
public:
    // Remaining seconds of the task `what`, of which `fraction` is done at time `now`, in seconds; 0 if unknown: at the
    // beginning, and if nothing is done yet.
    double seconds(const std::string &what, double fraction, double now);

private:
    std::string what_;
    double begin_ = 0.0, first_ = 0.0, last_ = 0.0;
};

// ", 40 s left", ", 3 min left", ", 2 h 5 min left"; empty if it is short.
std::string describe_time_left(double seconds);

// Threads: all methods may be called by any thread.
class Progress {
public:
    // Writes to `err` if `show` allows it; the terminal test applies to standard error.
    Progress(std::ostream &err, ShowProgress show);
    ~Progress();

    // `detail` follows the percentage, and the remaining time follows `detail`; if only these change, the line is
    // redrawn a few times per second.
    void update(const std::string &what, double fraction, const std::string &detail = std::string());
    void clear();

    // Prints a permanent line if progress is shown.
    void say(const std::string &line);

    // Prints a permanent line always.
    void warn(const std::string &line);

private:
    void clear_line();

    std::ostream &err_;
    bool shown_;
    int percent_ = -1;
    std::string what_, text_;
    TimeLeft left_;
    std::chrono::steady_clock::time_point drawn_;
    std::mutex mutex_;
};

// Shows progress as pictures and pixels done, with their rate. Threads: all methods may be called by any thread.
class Throughput {
public:
    Throughput(Progress &progress, const std::string &what, uint32_t pictures, uint64_t pixels);

    void add_pixels(uint64_t pixels);
    void add_picture();

    double seconds() const;  // since the start
    double megapixels() const;

    // "40 pictures, 480.0 megapixels in 9.8 s: 4.1 pictures/s, 49.0 megapixels/s"
    std::string summary() const;

private:
    void show();

    Progress &progress_;
    const std::string what_;
    const uint32_t pictures_;
    const uint64_t pixels_;
    const std::chrono::steady_clock::time_point begin_;
    mutable std::mutex mutex_;
    uint32_t pictures_done_ = 0;
    uint64_t pixels_done_ = 0;
};

}  // namespace lensprof
