// `lensprof profile check ID... --against PICTURES`: which of several profiles fits overlapping pictures best.
#pragma once

#include <string>
#include <vector>

#include "cli/program/options.hpp"
#include "cli/program/run.hpp"

namespace lensprof {

struct AgainstOptions {
    std::vector<std::string> words;  // ids, and further pictures
    std::vector<std::string> pictures;
    std::string images;
    bool progress = false;

    bool is_requested() const { return !words.empty() || !pictures.empty() || !images.empty(); }
};

void declare_against(Command &command, AgainstOptions &o);

// Uses the database `db`; writes nothing. Returns the exit code: not_usable if no profile is better than none.
int run_against(const AgainstOptions &o, const std::string &db, bool json, Streams &streams);

}  // namespace lensprof
