// The program in a separate process, for tests of its memory use and of interrupts.
#pragma once

#include <fcntl.h>

#include "batch_runs.hpp"

namespace program_runs {

using namespace batch_runs;

struct Ended {
    int code;   // or 128 + number of the signal that ended it
    long peak;  // of its memory use, bytes
    std::string err;
};

struct Child {
    pid_t id = -1;
    int err = -1;
    std::string said;  // on standard error
};

// `prepare` changes the new process: another limit, other processors.
inline Child start_program(
    const Words &words, const std::function<void()> &prepare = [] {}) {
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        std::vector<char *> arguments = {const_cast<char *>(LENSPROF_PROGRAM)};
        for (const std::string &word : words) arguments.push_back(const_cast<char *>(word.c_str()));
        arguments.push_back(nullptr);
        dup2(open("/dev/null", O_WRONLY), 1);
        dup2(ends[1], 2);
        close(ends[0]);
        close(ends[1]);
        prepare();
        execv(LENSPROF_PROGRAM, arguments.data());
        _exit(127);
    }
    close(ends[1]);
    return {child, ends[0], ""};
}

inline Ended run_program(
    const Words &words, const std::function<void()> &prepare = [] {}) {
    Child child = start_program(words, prepare);
    char buffer[4096];
    for (ssize_t got; (got = read(child.err, buffer, sizeof buffer)) > 0;) child.said.append(buffer, size_t(got));
    close(child.err);
    int status = 0;
    rusage used = {};
    assert_int_equal(wait4(child.id, &status, 0, &used), child.id);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), used.ru_maxrss * 1024, child.said};
}

}  // namespace program_runs
