#include "photo/base/format.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

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

namespace {

// Decimals that show two significant digits of an error, as far as `most`.
int decimals_of(double error, int most) {
    const std::string rounded = format("%.1e", error);  // 9.96e-3 is 0.010
    return std::clamp(1 - std::atoi(rounded.c_str() + rounded.find('e') + 1), 0, most);
}

}  // namespace

std::string error_text(double error) {
    constexpr int most = 9;
    if (error == 0.0) return "0";
    return error > 0.0 && std::isfinite(error) ? format("%.*f", decimals_of(error, most), error) : "-";
}

std::string with_decimals_of(double error, double number) {
    constexpr int most = 6;
    const bool is_known = error > 0.0 && std::isfinite(error);
    return format("%.*f", is_known ? decimals_of(error, most) : 1, number);
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
