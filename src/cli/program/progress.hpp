// One line on standard error that says how far a command is; only where somebody watches.
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

// How long a piece of work will take yet, by how much of it was done in the time since it began.
class TimeLeft {
public:
    // Seconds, of work called `what` of which `fraction` is done at the time `now`, in seconds; 0 where that is not
    // known: at the beginning, and where nothing is done yet.
    double seconds(const std::string &what, double fraction, double now);

private:
    std::string what_;
    double begin_ = 0.0, first_ = 0.0, last_ = 0.0;
};

// ", 40 s left", ", 3 min left", ", 2 h 5 min left"; empty where it is short.
std::string describe_time_left(double seconds);

// Threads: all methods may be called by any thread.
class Progress {
public:
    // `err` is written to when `show` says so; the terminal test is for standard error.
    Progress(std::ostream &err, ShowProgress show);
    ~Progress();

    // `detail` follows the percentage, and the time left that; where they alone change the line is drawn again a few
    // times a second.
    void update(const std::string &what, double fraction, const std::string &detail = std::string());
    void clear();

    // A line that stays, where progress is shown.
    void say(const std::string &line);

    // A line that stays, always.
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

// Pictures and pixels that are done, and how fast, as progress. Threads: all methods may be called by any thread.
class Throughput {
public:
    Throughput(Progress &progress, const std::string &what, uint32_t pictures, uint64_t pixels);

    void add_pixels(uint64_t pixels);
    void add_picture();

    double seconds() const;  // since the beginning
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
