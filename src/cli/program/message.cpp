#include "cli/program/message.hpp"

#include <cstdlib>
#include <cstring>

#include "photo/base/format.hpp"
#include "photo/base/shell_word.hpp"
#include "photo/base/utf8.hpp"
#include "photo/system/system.hpp"

namespace lensprof {
namespace {

// `code`: of ECMA-48, select graphic rendition.
std::string marked_line(bool colour, const char *code, const std::string &mark, const std::string &text) {
    return "lensprof: " + (colour ? std::string("\033[") + code + "m" + mark + "\033[0m" : mark) + " " + one_line(text);
}

}  // namespace

bool shows_colour() {
    const char *no_color = std::getenv("NO_COLOR"), *terminal = std::getenv("TERM");
    return system::is_terminal(stderr) && !(no_color && *no_color) && terminal && std::strcmp(terminal, "dumb") != 0;
}

void print_message(Streams &streams, const std::string &text) { streams.err << "lensprof: " << one_line(text) << "\n"; }

void warn(Streams &streams, const std::string &text) {
    if (streams.verbosity != Verbosity::quiet)
        streams.err << marked_line(streams.colour, "1;33", "warning:", text) << "\n";
    streams.warnings.push_back(one_line(text));
}

void note(Streams &streams, const std::string &text) {
    if (streams.verbosity != Verbosity::quiet) streams.err << marked_line(streams.colour, "36", "note:", text) << "\n";
}

std::string command_text(const std::vector<std::string> &words) {
    std::string text = "lensprof";
    for (const std::string &word : words) text += " " + shell_word(word);
    return text;
}

}  // namespace lensprof
