// The commands and options that help texts list.
#pragma once

#include "cli_runs.hpp"

namespace help_runs {

using namespace cli_runs;

// The first words of the lines of a section of a help text, "  WORD  about".
inline Words section_of(const std::string &help, const std::string &title) {
    std::istringstream lines(help);
    Words words;
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (!line.empty() && line[0] != ' ') inside = line == title + ":";
        if (inside && line.size() > 2 && line[0] == ' ' && line[2] != ' ')
            words.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
    return words;
}

// All commands and verbs, as words.
inline std::vector<Words> all_commands() {
    std::vector<Words> commands;
    for (const std::string &name : section_of(must_exit(done, {"help"}), "Commands")) {
        const Words verbs = section_of(must_exit(done, {"help", name}), "Commands");
        if (verbs.empty()) commands.push_back({name});
        for (const std::string &verb : verbs) commands.push_back({name, verb});
    }
    return commands;
}

// "--seed" from "  --seed COUNT   about", "--output" from "  -o,--output FILE   about", for options that take a value.
inline Words options_with_values(const std::string &help) {
    std::istringstream lines(help);
    Words options;
    for (std::string line; std::getline(lines, line);) {
        const auto match = find_pattern("^  (-[a-z],)?(--[a-z-]+) [^ ]", line);
        if (!match.empty()) options.push_back(line.substr(match[2].first, match[2].second));
    }
    return options;
}

// Each key of each KEY=VALUE option of a complete help: "--fit" and "huber" of "   huber=NUMBER: ..." below "  --fit".
inline std::vector<std::pair<std::string, std::string>> keys_of(const std::string &help) {
    std::istringstream lines(help);
    std::string option;
    std::vector<std::pair<std::string, std::string>> keys;
    for (std::string line; std::getline(lines, line);) {
        const auto named = find_pattern("^  (-[a-z],)?(--[a-z-]+)", line),
                   key = find_pattern("^   +([a-z-]+)=[^ ]+: ", line);
        if (!named.empty())
            option = find_pattern("KEY=[A-Z]+,", line).empty() ? "" : line.substr(named[2].first, named[2].second);
        if (!key.empty() && !option.empty()) keys.emplace_back(option, line.substr(key[1].first, key[1].second));
    }
    return keys;
}

}  // namespace help_runs
