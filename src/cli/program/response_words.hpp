// A response in the words of an option.
#pragma once

#include <string>

#include <lensprof/model.h>

namespace lensprof {

// linear, srgb, gamma:G, film (an S like film's), or emor:a,b,... (EMoR coefficients); throws std::invalid_argument
// with what is wrong with another word.
lensprof_response response_of_word(const std::string &word);

}  // namespace lensprof
