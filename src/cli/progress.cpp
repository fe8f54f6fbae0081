#include "progress.hpp"

#include <algorithm>
#include <iostream>

#include <unistd.h>

namespace lensprof {

Progress::Progress(std::ostream &err, ShowProgress show)
    : err_(err), shown_(show == ShowProgress::always
                        || (show == ShowProgress::when_terminal && &err == &std::cerr && isatty(STDERR_FILENO))) {}

Progress::~Progress() { clear(); }

void Progress::update(const std::string &what, double fraction) {
    if (!shown_) return;
    std::lock_guard<std::mutex> lock(mutex_);
    int percent = std::clamp(static_cast<int>(100.0 * fraction), 0, 100);
    if (percent == percent_ && what == what_) return;
    percent_ = percent;
    what_ = what;
    err_ << "\r\033[K" << what << " " << percent << " %" << std::flush;
}

void Progress::clear() {
    std::lock_guard<std::mutex> lock(mutex_);
    if (percent_ >= 0) err_ << "\r\033[K" << std::flush;
    percent_ = -1;
}

}  // namespace lensprof
