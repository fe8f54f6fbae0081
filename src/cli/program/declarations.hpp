// Typed values that a command accepts: of its options, and of the keys of a KEY=VALUE option.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/program/numbers.hpp"

namespace lensprof {

// The value of each word of an option.
template <class Value>
using Choices = std::vector<std::pair<const char *, Value>>;

// Declares values, which must live until the program ends: declare_... functions keep theirs in the action.
class Declarations {
public:
    virtual ~Declarations() = default;

    // For values with their own syntax: `read` sets the value, or throws std::invalid_argument with the reason.
    using Read = std::function<void(const std::string &)>;
    virtual void word(const char *names, const std::string &type, const Read &read, const std::string &about) = 0;
    virtual void flag(const char *names, bool &value, const std::string &about) = 0;

    void text(const char *names, std::string &value, const std::string &about);
    void file(const char *names, std::string &value, const std::string &about);
    void folder(const char *names, std::string &value, const std::string &about);
    void number(const char *names, double &value, const Quantity &quantity, const std::string &about);
    void number(const char *names, std::optional<double> &value, const Quantity &quantity, const std::string &about);
    void count(const char *names, uint32_t &value, uint32_t low, uint32_t high, const std::string &about);
    void numbers(const char *names, std::vector<double> &values, const Quantity &quantity, const std::string &about);
    void counts(const char *names, std::vector<uint32_t> &values, uint32_t low, uint32_t high,
                const std::string &about);
    void size(const char *names, uint32_t &width, uint32_t &height, std::pair<uint32_t, uint32_t> ends,
              const std::string &about);
    void profile_id(const char *names, int64_t &value, const std::string &about);

    // One of these words.
    template <class Value>
    void choice(const char *names, Value &value, const Choices<Value> &choices, const std::string &about) {
        choice_of(
            names, words_of(choices), [&value, choices](size_t i) { value = choices[i].second; }, about);
    }
    // Several words, separated by commas.
    template <class Value>
    void list(const char *names, std::vector<Value> &values, const Choices<Value> &choices, const std::string &about) {
        list_of(
            names, words_of(choices), [&values] { values.clear(); },
            [&values, choices](size_t i) { values.push_back(choices[i].second); }, about);
    }

private:
    template <class Value>
    static std::vector<std::string> words_of(const Choices<Value> &choices) {
        std::vector<std::string> words;
        for (const auto &choice : choices) words.emplace_back(choice.first);
        return words;
    }
    void choice_of(const char *names, const std::vector<std::string> &words, const std::function<void(size_t)> &choose,
                   const std::string &about);
    void list_of(const char *names, const std::vector<std::string> &words, const std::function<void()> &clear,
                 const std::function<void(size_t)> &choose, const std::string &about);
};

// Parses a profile id; throws std::invalid_argument.
int64_t profile_id_of(const std::string &word);

// The index of a word in a list; throws std::invalid_argument with the list.
size_t index_of(const std::string &word, const std::vector<std::string> &words);

}  // namespace lensprof
