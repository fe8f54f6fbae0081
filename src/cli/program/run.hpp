// The program as a function, so that tests can run it in process.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace lensprof {

// Output of a command: results to `out`, everything else to `err`.
struct Streams {
    std::ostream &out;
    std::ostream &err;
    std::vector<std::string> words = {};     // of the command line
    std::vector<std::string> warnings = {};  // that were written to `err`, without "warning: "
};

// Runs the program and returns its exit code (ExitCode in error.hpp).
int run(const std::vector<std::string> &words, Streams &streams);

}  // namespace lensprof
