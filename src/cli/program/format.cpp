#include "cli/program/format.hpp"

#include <cstdarg>
#include <cstdio>

namespace lensprof {

std::string format(const char *pattern, ...) {
    va_list arguments, again;
    va_start(arguments, pattern);
    va_copy(again, arguments);
    std::string text(static_cast<size_t>(std::vsnprintf(nullptr, 0, pattern, arguments)), '\0');
    std::vsnprintf(text.data(), text.size() + 1, pattern, again);
    va_end(again);
    va_end(arguments);
    return text;
}

std::string counted(size_t count, const std::string &thing, const std::string &things) {
    return std::to_string(count) + " " + (count == 1 ? thing : things.empty() ? thing + "s" : things);
}

std::string listed(const std::vector<uint32_t> &numbers, const std::vector<std::string> &names) {
    constexpr size_t most = 5;
    std::string text;
    for (size_t n = 0; n < numbers.size() && n < most; n++) text += (n ? ", " : "") + names[numbers[n]];
    if (numbers.size() > most) text += format(" and %zu more", numbers.size() - most);
    return text;
}

std::string joined(const std::vector<std::string> &words, const std::string &separator) {
    std::string text;
    for (size_t i = 0; i < words.size(); i++) text += (i ? separator : "") + words[i];
    return text;
}

std::string shell_quoted(const std::string &text) {
    std::string escaped;
    for (const char c : text) escaped += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return "'" + escaped + "'";
}

}  // namespace lensprof
