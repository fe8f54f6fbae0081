// The program in a separate process, for tests of its memory use.
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

// `prepare` changes the new process: another limit, other processors.
inline Ended run_program(
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
        prepare();
        execv(LENSPROF_PROGRAM, arguments.data());
        _exit(127);
    }
    close(ends[1]);
    std::string err;
    char buffer[4096];
    for (ssize_t got; (got = read(ends[0], buffer, sizeof buffer)) > 0;) err.append(buffer, size_t(got));
    close(ends[0]);
    int status = 0;
    rusage used = {};
    assert_int_equal(wait4(child, &status, 0, &used), child);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), used.ru_maxrss * 1024, err};
}

}  // namespace program_runs
