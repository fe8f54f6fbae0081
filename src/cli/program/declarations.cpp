#include "cli/program/declarations.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>

#include "photo/base/format.hpp"
#include "photo/base/nearest.hpp"

namespace lensprof {

int64_t profile_id_of(const std::string &word) {
    const bool has_only_digits = word.find_first_not_of("0123456789") == std::string::npos;
    errno = 0;
    const unsigned long long id = has_only_digits ? std::strtoull(word.c_str(), nullptr, 10) : 0;
    if (id == 0 || errno != 0 || id > INT64_MAX)
        throw std::invalid_argument(word + " is not a profile id; see `lensprof profile list`");
    return static_cast<int64_t>(id);
}

size_t index_of(const std::string &word, const std::vector<std::string> &words) {
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end())
        throw std::invalid_argument(word + ": use " + joined(words, ", ") + did_you_mean(word, words));
    return static_cast<size_t>(found - words.begin());
}

void Declarations::text(const char *names, std::string &value, const std::string &about) {
    word(
        names, "TEXT", [&value](const std::string &given) { value = given; }, about);
}

void Declarations::file(const char *names, std::string &value, const std::string &about) {
    word(
        names, "FILE", [&value](const std::string &given) { value = given; }, about);
}

void Declarations::folder(const char *names, std::string &value, const std::string &about) {
    word(
        names, "FOLDER", [&value](const std::string &given) { value = given; }, about);
}

void Declarations::number(const char *names, double &value, const Quantity &quantity, const std::string &about) {
    word(
        names, "NUMBER", [&value, quantity](const std::string &given) { value = number_of(given, quantity); }, about);
}

void Declarations::number(const char *names, std::optional<double> &value, const Quantity &quantity,
                          const std::string &about) {
    word(
        names, "NUMBER", [&value, quantity](const std::string &given) { value = number_of(given, quantity); }, about);
}

void Declarations::count(const char *names, uint32_t &value, uint32_t low, uint32_t high, const std::string &about) {
    word(
        names, "COUNT", [&value, low, high](const std::string &given) { value = count_of(given, low, high); }, about);
}

void Declarations::numbers(const char *names, std::vector<double> &values, const Quantity &quantity,
                           const std::string &about) {
    const auto read = [&values, quantity](const std::string &list) {
        values.clear();
        for (const std::string &element : elements(list)) values.push_back(number_of(element, quantity));
    };
    word(names, "NUMBER,...", read, about);
}

void Declarations::counts(const char *names, std::vector<uint32_t> &values, uint32_t low, uint32_t high,
                          const std::string &about) {
    const auto read = [&values, low, high](const std::string &list) {
        values.clear();
        for (const std::string &element : elements(list)) values.push_back(count_of(element, low, high));
    };
    word(names, "COUNT,...", read, about);
}

void Declarations::size(const char *names, uint32_t &width, uint32_t &height, std::pair<uint32_t, uint32_t> ends,
                        const std::string &about) {
    const auto read = [&width, &height, ends](const std::string &given) {
        const std::vector<std::string> sides = split(given, 'x');
        if (sides.size() != 2) throw std::invalid_argument(given + ": give WIDTHxHEIGHT");
        const uint32_t w = count_of(sides[0], ends.first, ends.second), h = count_of(sides[1], ends.first, ends.second);
        width = w, height = h;
    };
    word(names, "WIDTHxHEIGHT", read, about);
}

void Declarations::profile_id(const char *names, int64_t &value, const std::string &about) {
    word(
        names, "ID", [&value](const std::string &given) { value = profile_id_of(given); }, about);
}

void Declarations::choice_of(const char *names, const std::vector<std::string> &words,
                             const std::function<void(size_t)> &choose, const std::string &about) {
    word(
        names, joined(words, "|"), [words, choose](const std::string &given) { choose(index_of(given, words)); },
        about);
}

void Declarations::list_of(const char *names, const std::vector<std::string> &words, const std::function<void()> &clear,
                           const std::function<void(size_t)> &choose, const std::string &about) {
    const auto read = [words, clear, choose](const std::string &list) {
        clear();
        for (const std::string &element : elements(list)) choose(index_of(element, words));
    };
    word(names, joined(words, "|") + ",...", read, about);
}

}  // namespace lensprof
