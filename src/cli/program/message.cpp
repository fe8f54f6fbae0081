#include "cli/program/message.hpp"

#include "cli/program/format.hpp"
#include "cli/program/utf8.hpp"

namespace lensprof {

void tell(Streams &streams, const std::string &text) { streams.err << "lensprof: " << one_line(text) << "\n"; }

void warn(Streams &streams, const std::string &text) {
    tell(streams, "warning: " + text);
    streams.warnings.push_back(one_line(text));
}

void note(Streams &streams, const std::string &text) { tell(streams, "note: " + text); }

std::string command_text(const std::vector<std::string> &words) {
    constexpr const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./,:=+@%";
    std::string text = "lensprof";
    for (const std::string &word : words) {
        const bool is_plain = !word.empty() && word.find_first_not_of(plain) == std::string::npos;
        text += " " + (is_plain ? word : shell_quoted(word));
    }
    return text;
}

}  // namespace lensprof
