/* progress.hpp - one line on standard error that says how far a command is; only where somebody watches. */
#ifndef LENSPROF_CLI_PROGRESS_HPP
#define LENSPROF_CLI_PROGRESS_HPP

#include <mutex>
#include <ostream>
#include <string>

namespace lensprof {

enum class ShowProgress { when_terminal, always, never };

/* Threads: all methods may be called by any thread. */
class Progress {
public:
    /* `err` is written to when `show` says so; the terminal test is for standard error. */
    Progress(std::ostream &err, ShowProgress show);
    ~Progress();

    void update(const std::string &what, double fraction);
    void clear();

private:
    std::ostream &err_;
    bool shown_;
    int percent_ = -1;
    std::string what_;
    std::mutex mutex_;
};

}  // namespace lensprof

#endif
