// Numbers in the words of an option.
#pragma once

#include <string>
#include <vector>

namespace lensprof {

// "0.125", "1e-3" or "1/8". Failure (usage) names the option and the word.
double number_of(const std::string &word, const std::string &option);

// The numbers of a list with commas.
std::vector<double> numbers_of(const std::string &list, const std::string &option);

// The same, one for each of `count` `things` ("pictures").
std::vector<double> numbers_of(const std::string &list, const std::string &option, size_t count, const char *things);

}  // namespace lensprof
