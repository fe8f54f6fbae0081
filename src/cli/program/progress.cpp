#include "cli/program/progress.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iostream>

#include "cli/program/interrupt.hpp"
#include "cli/program/message.hpp"
#include "cli/program/option_names.hpp"
#include "photo/base/format.hpp"
#include "photo/base/utf8.hpp"
#include "photo/system/system.hpp"

namespace lensprof {
namespace {

constexpr std::chrono::milliseconds detail_interval(200);

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

double TimeLeft::seconds(const std::string &task, double fraction, double now) {
    constexpr double min_seconds = 2.0, min_share = 0.01;  // seconds, and share, from which on the rate is reliable
    constexpr double min_restart_drop = 0.05;              // larger than the steps back between threads
    if (task != task_ || fraction < last_ - min_restart_drop) {
        task_ = task;
        begin_ = now, first_ = fraction;
    }
    last_ = fraction, now_ = now;
    const double elapsed = now - begin_, done = fraction - first_;
    return elapsed < min_seconds || done < min_share ? 0.0 : elapsed * std::max(1.0 - fraction, 0.0) / done;
}

double TimeLeft::rate() const {
    constexpr double soonest = 0.5;  // seconds
    return now_ - begin_ >= soonest ? std::max(last_ - first_, 0.0) / (now_ - begin_) : 0.0;
}

std::string describe_time_left(double seconds) {
    if (seconds < 5.0) return {};
    if (seconds <= 60.0) return format(", %.0f s left", std::ceil(seconds));
    const double minutes = std::ceil(seconds / 60.0);
    if (minutes < 60.0) return format(", %.0f min left", minutes);
    return format(", %.0f h %.0f min left", std::floor(minutes / 60.0), std::fmod(minutes, 60.0));
}

Progress::Progress(Streams &streams, bool always)
    : streams_(streams),
      err_(streams.err),
      verbosity_(streams.verbosity),
      is_shown_(verbosity_ != Verbosity::quiet && (always || (&err_ == &std::cerr && system::is_terminal(stderr)))) {}

Progress::~Progress() { clear(); }

void Progress::update(const std::string &what, double fraction, const std::string &detail) {
    draw(what, fraction, [&] { return detail; });
}

void Progress::update_items(const std::string &what, uint32_t done, uint32_t count) {
    draw(what, static_cast<double>(done) / std::max(count, 1u), [&] {
        const double rate = left_.rate() * count;
        return format(", %u of %u", done, count) + (rate > 0.0 ? format(", %.*f/s", rate < 10.0 ? 1 : 0, rate) : "");
    });
}

void Progress::draw(const std::string &what, double fraction, const std::function<std::string()> &detail) {
    if (!is_shown_ && verbosity_ != Verbosity::verbose) return;
    std::lock_guard<std::mutex> lock(mutex_);
    auto now = std::chrono::steady_clock::now();
    if (what != step_) {
        end_step();
        step_ = what;
        step_begin_ = now;
        step_cpu_begin_ = std::clock();
    }
    if (!is_shown_) return;
    int percent = std::clamp(static_cast<int>(100.0 * fraction), 0, 100);
    const double left = left_.seconds(what, fraction, std::chrono::duration<double>(now.time_since_epoch()).count());
    const bool is_same_percent = percent == percent_ && what == what_;
    if (is_same_percent && now - drawn_ < detail_interval) return;
    const std::string text = what + format(" %d %%", percent) + detail() + describe_time_left(left);
    if (is_same_percent && text == text_) return;
    percent_ = percent;
    what_ = what;
    text_ = text;
    drawn_ = now;
    err_ << "\r\033[K" << text << std::flush;
}

void Progress::clear() {
    std::lock_guard<std::mutex> lock(mutex_);
    end_step();
    clear_line();
}

void Progress::clear_line() {
    if (percent_ >= 0) err_ << "\r\033[K" << std::flush;
    percent_ = -1;
}

void Progress::end_step() {
    if (verbosity_ == Verbosity::verbose && !step_.empty()) {
        clear_line();
        const double cpu = static_cast<double>(std::clock() - step_cpu_begin_) / CLOCKS_PER_SEC;
        err_ << "lensprof: " << step_ << format(": %.2f s, CPU %.2f s", seconds_since(step_begin_), cpu) << std::endl;
    }
    step_.clear();
}

void Progress::finish(const std::string &summary) {
    clear();
    if (!is_shown_) return;
    std::lock_guard<std::mutex> lock(mutex_);
    err_ << summary << std::endl;
}

void Progress::notice(uint32_t severity, const std::string &item, const std::string &text) {
    std::lock_guard<std::mutex> lock(mutex_);
    clear_line();
    const std::string line = item.empty() ? text : item + ": " + text;
    severity == LENSPROF_SEVERITY_WARNING ? lensprof::warn(streams_, line) : lensprof::note(streams_, line);
    err_.flush();
}

bool Progress::is_cancelled() { return interrupted(); }

std::string Progress::option_name(const std::string &name) { return option_of(name); }

std::string Progress::advice(const std::string &situation) { return advice_for(situation); }

}  // namespace lensprof
