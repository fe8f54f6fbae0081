#include "formats/text/numbers.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace lensprof {

namespace {

#ifdef __EMSCRIPTEN__  // its C++ library converts no floating point numbers, and its C library has one locale

bool read(std::string_view text, double &value) {
    if (text.empty() || text[0] == '+' || text.find_first_not_of("0123456789.eE+-") != text.npos) return false;
    const std::string terminated(text);
    char *end = nullptr;
    value = std::strtod(terminated.c_str(), &end);
    return end == terminated.c_str() + terminated.size();
}

bool reads_back(const char *text, double value) { return std::strtod(text, nullptr) == value; }
bool reads_back(const char *text, float value) { return std::strtof(text, nullptr) == value; }

// With the fewest digits that read back; with or without exponent, whichever is shorter.
template <class Number>
std::string shortest(Number value, bool is_fixed) {
    char scientific[40], fixed[400];
    int digits = 0;
    do std::snprintf(scientific, sizeof scientific, "%.*e", digits, static_cast<double>(value));
    while (!reads_back(scientific, value) && ++digits < 17);
    const std::string text = scientific;
    const int exponent = std::atoi(text.c_str() + text.find('e') + 1);
    std::snprintf(fixed, sizeof fixed, "%.*f", std::max(0, digits - exponent), static_cast<double>(value));
    const std::string plain = fixed;
    return is_fixed || plain.size() <= text.size() ? plain : text;
}

#else

bool read(std::string_view text, double &value) {
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
    return failed == std::errc() && end == text.data() + text.size();
}

template <class Number>
std::string shortest(Number value, bool is_fixed) {
    char buffer[400], *const end = buffer + sizeof buffer;
    const auto result =
        is_fixed ? std::to_chars(buffer, end, value, std::chars_format::fixed) : std::to_chars(buffer, end, value);
    return std::string(buffer, result.ptr);
}

#endif

// No "-0".
template <class Number>
std::string text_of(Number value, bool is_fixed = false) {
    return shortest(value == 0 ? Number(0) : value, is_fixed);
}

}  // namespace

bool read_number(std::string_view text, double &value) {
    if (!text.empty() && text[0] == '+') text.remove_prefix(1);
    double number;
    if (!read(text, number) || !std::isfinite(number)) return false;
    value = number;
    return true;
}

bool read_whole(std::string_view text, double low, double high, double &value) {
    double number;
    if (!read_number(text, number) || number != std::floor(number) || number < low || number > high) return false;
    value = number;
    return true;
}

std::string number_text(double value) { return text_of(value); }

std::string float_text(double value) {
    const std::string text = text_of(static_cast<float>(value));
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string fixed_text(double value) { return text_of(value, true); }

}  // namespace lensprof
