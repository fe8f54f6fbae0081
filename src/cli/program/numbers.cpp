#include "cli/program/numbers.hpp"

#include <cmath>
#include <sstream>

#include "cli/program/error.hpp"

namespace lensprof {

double number_of(const std::string &word, const std::string &option) {
    std::istringstream text(word);
    double value = 0.0, divisor = 1.0;
    char slash = '/';
    bool good = static_cast<bool>(text >> value);
    if (good && text.peek() == '/') good = (text >> slash >> divisor) && divisor > 0.0;
    if (!good || text.peek() != EOF || !std::isfinite(value / divisor))
        throw Failure(ExitCode::usage, option + ": '" + word + "' is not a number; separate numbers with commas");
    return value / divisor;
}

std::vector<double> numbers_of(const std::string &list, const std::string &option) {
    std::vector<double> values;
    std::istringstream text(list + ",");
    for (std::string word; std::getline(text, word, ',');) values.push_back(number_of(word, option));
    return values;
}

std::vector<double> numbers_of(const std::string &list, const std::string &option, size_t count, const char *things) {
    std::vector<double> values = numbers_of(list, option);
    if (values.size() != count)
        throw Failure(ExitCode::usage, option + ": " + std::to_string(values.size()) + " values for "
                                           + std::to_string(count) + " " + things
                                           + "; give one for each, in their order");
    return values;
}

}  // namespace lensprof
