// The program as a function, so that tests can run it in process.
#pragma once

#include <ostream>
#include <string>
#include <vector>
#include "cli/program/exit_code.hpp"

namespace lensprof {

enum class Verbosity {
    quiet,   // errors only
    normal,  // and warnings, notes, and progress on a terminal
    verbose  // and the time that each step takes
};

// Output of a command: results to `out`, everything else to `err`.
struct Streams {
    std::ostream &out;
    std::ostream &err;
    std::vector<std::string> words = {};     // of the command line
    std::vector<std::string> warnings = {};  // given, without "warning: "
    Verbosity verbosity = Verbosity::normal;
    bool colour = false;  // of the words "warning:" and "note:"

    // The same with other targets.
    Streams with(std::ostream &other_out, std::ostream &other_err) const {
        return {other_out, other_err, words, warnings, verbosity, colour};
    }
};

// Runs the program and returns its exit code (ExitCode in error.hpp).
int run(const std::vector<std::string> &words, Streams &streams);

}  // namespace lensprof
