// Parsing of a response given as an option value.
#pragma once

#include <string>

#include <lensprof/model.h>

namespace lensprof {

// linear, srgb, gamma:G, film (an S curve like that of film), emor:a,b,... (EMoR coefficients), or the name of a file
// with one response, such as pcalib.txt; throws std::invalid_argument with the reason for other words. Failure
// (unreadable) for a file that does not hold one.
lensprof_response response_of_word(const std::string &word);

}  // namespace lensprof
