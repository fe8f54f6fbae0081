// A progress line on standard error; shown only on a terminal unless requested.
#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <functional>
#include <mutex>
#include <ostream>
#include <string>

#include "cli/program/run.hpp"
#include "photo/base/events.hpp"

namespace lensprof {

// Estimates the remaining time of a task from the share done since it started.
class TimeLeft {
public:
    // Remaining seconds of `task`, of which `fraction` is done at time `now`, in seconds; 0 if unknown: at the
    // beginning, and if nothing is done yet.
    double seconds(const std::string &task, double fraction, double now);

    // The share done per second since the start of the task; 0 if unknown.
    double rate() const;

private:
    std::string task_;
    double begin_ = 0.0, first_ = 0.0, last_ = 0.0, now_ = 0.0;
};

// ", 40 s left", ", 3 min left", ", 2 h 5 min left"; empty if it is short.
std::string describe_time_left(double seconds);

// Threads: all methods may be called by any thread.
class Progress : public Events {
public:
    // Shows progress on `streams.err` if it is a terminal or `always`, and not with --quiet. With --verbose, prints a
    // line with the time of each step.
    explicit Progress(Streams &streams, bool always = false);
    ~Progress() override;

    // `detail` follows the percentage, and the remaining time follows `detail`; if only these change, the line is
    // redrawn a few times per second.
    void update(const std::string &what, double fraction, const std::string &detail = {}) override;

    // With the number of items and their rate: ", 12 of 40, 3.1/s".
    void update_items(const std::string &what, uint32_t done, uint32_t count) override;

    void clear() override;
    void finish(const std::string &summary) override;  // prints the line if progress is shown

    // Prints a permanent line, except with --quiet.
    void notice(uint32_t severity, const std::string &item, const std::string &text) override;

    bool is_cancelled() override;  // Ctrl-C
    std::string option_name(const std::string &name) override;
    std::string advice(const std::string &situation) override;

private:
    void draw(const std::string &what, double fraction, const std::function<std::string()> &detail);
    void clear_line();
    void end_step();

    Streams &streams_;
    std::ostream &err_;
    const Verbosity verbosity_;
    const bool is_shown_;
    int percent_ = -1;
    std::string what_, text_, step_;
    TimeLeft left_;
    std::chrono::steady_clock::time_point step_begin_;
    std::clock_t step_cpu_begin_ = 0;  // of all threads
    std::chrono::steady_clock::time_point drawn_;
    std::mutex mutex_;
};

}  // namespace lensprof
