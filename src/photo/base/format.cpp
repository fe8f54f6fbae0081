#include "photo/base/format.hpp"

#include <cstdarg>
#include <cstdio>

#include "photo/base/failure.hpp"

namespace lensprof {

std::string format(const char *pattern, ...) {
    va_list arguments, arguments_copy;
    va_start(arguments, pattern);
    va_copy(arguments_copy, arguments);
    std::string text(static_cast<size_t>(std::vsnprintf(nullptr, 0, pattern, arguments)), '\0');
    std::vsnprintf(text.data(), text.size() + 1, pattern, arguments_copy);
    va_end(arguments_copy);
    va_end(arguments);
    return text;
}

std::string counted(size_t count, const std::string &singular, const std::string &plural) {
    return std::to_string(count) + " " + (count == 1 ? singular : plural.empty() ? singular + "s" : plural);
}

void require_count(size_t values, const std::string &option, size_t count, const std::string &singular) {
    if (values != count)
        throw Failure(LENSPROF_ERROR_ARGUMENT, option + ": " + counted(values, "value") + " for "
                                                   + counted(count, singular) + "; give one for each, in their order");
}

std::string listed(const std::vector<uint32_t> &numbers, const std::vector<std::string> &names) {
    constexpr size_t max_names = 5;
    std::string text;
    for (size_t n = 0; n < numbers.size() && n < max_names; n++) text += (n ? ", " : "") + names[numbers[n]];
    if (numbers.size() > max_names) text += format(" and %zu more", numbers.size() - max_names);
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
