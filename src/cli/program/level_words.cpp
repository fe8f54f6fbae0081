#include "cli/program/level_words.hpp"

#include <stdexcept>

#include "cli/program/numbers.hpp"

namespace lensprof {
namespace {

constexpr double most_percent = 100.0;
constexpr double most_sample = 1e9;  // of float counts

StatedLevel level_of(const std::string &word, double least_percent) {
    if (!word.empty() && word.back() == '%')
        return {number_of(word.substr(0, word.size() - 1), {least_percent, most_percent}) / 100.0, true};
    return {number_of(word, {0.0, most_sample}), false};
}

}  // namespace

std::vector<StatedLevel> black_levels_of(const std::string &word) {
    std::vector<StatedLevel> levels;
    for (const std::string &part : split(word, ':')) levels.push_back(level_of(part, -50.0));
    if (levels.size() != 1 && levels.size() != 3)
        throw std::invalid_argument(word + ": not one level, nor RED:GREEN:BLUE");
    return levels;
}

StatedLevel white_level_of(const std::string &word) {
    const StatedLevel white = level_of(word, 0.0);
    if (white.number == 0.0) throw std::invalid_argument(word + ": the white level cannot be 0");
    return white;
}

}  // namespace lensprof
