// Which word was meant.
#pragma once

#include <string>
#include <vector>

namespace lensprof {

// The shortest of `words` that begins with `word`; else the one with the fewest letters changed, left out, added or
// swapped with their neighbour (optimal string alignment), the first of several; empty where all differ in more than a
// third of the letters. Capital and small letters are the same.
std::string nearest_of(const std::string &word, const std::vector<std::string> &words);

// How many letters are changed, left out, added or swapped between two words; capital and small letters are the same.
size_t letters_changed(const std::string &a, const std::string &b);

// "; did you mean NEAREST?", or empty.
std::string did_you_mean(const std::string &word, const std::vector<std::string> &words);

}  // namespace lensprof
