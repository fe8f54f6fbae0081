#include "cli/program/options.hpp"

#include <cstdlib>
#include <sstream>

#include <CLI/CLI.hpp>

#include "cli/program/error.hpp"

namespace lensprof {

bool parse(CLI::App &app, const std::vector<std::string> &arguments, Streams &streams) {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    try {
        app.parse(reversed);
        return true;
    } catch (const CLI::CallForHelp &) {
        streams.out << app.help();
        return false;
    } catch (const CLI::ParseError &e) {
        throw Failure(ExitCode::usage, std::string(e.what()) + "; see `" + app.get_name() + " --help`");
    }
}

void declare_db(CLI::App &app, std::string &path, const std::string &more) {
    app.add_option("--db", path, "profile database" + more + "; default the user's own")
        ->check([](const std::string &name) {
            return name.empty() ? std::string("names no file; leave it out for the user's own database")
                                : std::string();
        });
}

std::string is_profile_id(const std::string &word) {
    const bool digits = !word.empty() && word.size() < 19 && word.find_first_not_of("0123456789") == std::string::npos;
    if (digits && word.find_first_not_of('0') != std::string::npos) return "";
    return word + " is no number of a profile; `lensprof profile list` shows them";
}

std::function<std::string(const std::string &)> in_range(double low, double high) {
    return [low, high](const std::string &word) {
        char *end = nullptr;
        double value = std::strtod(word.c_str(), &end);
        if (*end == 0 && end != word.c_str() && value >= low && value <= high) return std::string();
        std::ostringstream text;
        text << word << " is not a number from " << low << " to " << high;
        return text.str();
    };
}

}  // namespace lensprof
