// Finds the word that was probably meant.
#pragma once

#include <string>
#include <vector>

namespace lensprof {

// The shortest of `words` that starts with `word`; else the one with the fewest letters changed, omitted, added or
// swapped with a neighbour (optimal string alignment), the first of several; empty if all differ in more than a third
// of the letters. Case is ignored.
std::string nearest_of(const std::string &word, const std::vector<std::string> &words);

// The number of letters changed, omitted, added or swapped between two words, ignoring case.
size_t letters_changed(const std::string &a, const std::string &b);

// "; did you mean NEAREST?", or empty.
std::string did_you_mean(const std::string &word, const std::vector<std::string> &words);

}  // namespace lensprof
