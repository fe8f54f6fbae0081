#include "cli/program/level_words.hpp"

#include <stdexcept>

#include "cli/program/numbers.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

constexpr double most_percent = 100.0, most_sample = 65535.0;
constexpr double most_count = 1e9;  // of float samples

StatedLevel level_of(const std::string &word, double least_percent, double most) {
    if (!word.empty() && word.back() == '%')
        return {number_of(word.substr(0, word.size() - 1), {least_percent, most_percent}) / 100.0, true};
    const double number = number_of(word, {0.0, most});
    if (number > 0.0 && number < 1.0)
        throw std::invalid_argument(word + ": give a value of the samples, such as 256, or a percentage, such as "
                                    + format("%g%%", 100.0 * number));
    return {number, false};
}

}  // namespace

std::vector<StatedLevel> black_levels_of(const std::string &word) {
    std::vector<StatedLevel> levels;
    for (const std::string &part : split(word, ':')) levels.push_back(level_of(part, -50.0, most_sample));
    if (levels.size() != 1 && levels.size() != 3)
        throw std::invalid_argument(word + ": not one level, nor RED:GREEN:BLUE");
    return levels;
}

StatedLevel white_level_of(const std::string &word) { return level_of(word, 0.0, most_count); }

}  // namespace lensprof
