#include "cli/program/numbers.hpp"

#include <cctype>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

struct UnitRule {
    const char *quantity, *unit, *examples;
};

UnitRule rule_of(Unit unit) {
    switch (unit) {
    case Unit::focal_mm: return {"a focal length", "mm", "50 or 50mm"};
    case Unit::f_number: return {"an aperture", "", "4, f/4 or F4"};
    case Unit::time_s: return {"an exposure time", "s", "0.5, 1/60 or 1/60s"};
    case Unit::distance_m: return {"a distance", "m", "3 or 3m"};
    case Unit::temperature_k: return {"a colour temperature", "K", "2850 or 2850K"};
    default: return {"", "", ""};
    }
}

std::string range_text(const Quantity &quantity) {
    std::ostringstream text;
    text << " is not a number from " << quantity.low << " to " << quantity.high;
    return text.str();
}

// Parses the decimal number, or infinity, at the start of `text` and removes it; false if not found.
bool parse_number(const char *&text, double &value) {
    const char *digits = text + (*text == '-' || *text == '+');
    const bool is_hexadecimal = digits[0] == '0' && (digits[1] == 'x' || digits[1] == 'X');
    if (is_hexadecimal || std::isspace(static_cast<unsigned char>(*text))) return false;
    char *end = nullptr;
    value = std::strtod(text, &end);
    const bool found = end != text;
    text = end;
    return found;
}

}  // namespace

double number_of(const std::string &word, const Quantity &quantity) {
    const char *text = word.c_str();
    if (quantity.unit == Unit::f_number && (*text == 'f' || *text == 'F')) text += text[1] == '/' ? 2 : 1;
    double value = 0.0, divisor = 1.0;
    bool is_valid = parse_number(text, value);
    const bool may_be_fraction = quantity.unit == Unit::none || quantity.unit == Unit::time_s;
    if (is_valid && may_be_fraction && *text == '/') is_valid = parse_number(++text, divisor) && divisor > 0.0;
    while (*text == ' ') text++;
    const UnitRule rule = rule_of(quantity.unit);
    const std::string suffix = text;
    if (is_valid && !suffix.empty() && quantity.unit != Unit::none && suffix != rule.unit)
        throw std::invalid_argument(word + ": '" + suffix + "' is not the unit of " + rule.quantity + "; give "
                                    + rule.examples);
    value /= divisor;
    if (!is_valid || (!suffix.empty() && suffix != rule.unit) || !(value >= quantity.low && value <= quantity.high))
        throw std::invalid_argument((word.empty() ? "an empty word" : word) + range_text(quantity));
    return value;
}

uint32_t count_of(const std::string &word, uint32_t low, uint32_t high) {
    const bool has_only_digits =
        !word.empty() && word.size() <= 10 && word.find_first_not_of("0123456789") == std::string::npos;
    const uint64_t value = has_only_digits ? std::strtoull(word.c_str(), nullptr, 10) : 0;
    if (!has_only_digits || value < low || value > high)
        throw std::invalid_argument(word + " is not an integer from " + std::to_string(low) + " to "
                                    + std::to_string(high));
    return static_cast<uint32_t>(value);
}

std::vector<std::string> split(const std::string &list, char separator) {
    std::vector<std::string> words(1);
    for (const char c : list)
        if (c == separator)
            words.emplace_back();
        else
            words.back() += c;
    return words;
}

std::vector<std::string> elements(const std::string &list) {
    const std::vector<std::string> words = split(list);
    for (const std::string &word : words)
        if (word.empty())
            throw std::invalid_argument(list + ": a value is missing before or after a comma; separate values by "
                                               "single commas");
    return words;
}

}  // namespace lensprof
