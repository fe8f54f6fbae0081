#include "cli/program/message.hpp"

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
        text += ' ';
        if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) {
            text += word;
            continue;
        }
        text += '\'';
        for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
        text += '\'';
    }
    return text;
}

}  // namespace lensprof
