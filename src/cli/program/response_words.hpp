// Parsing of a response given as an option value.
#pragma once

#include <string>

#include <lensprof/model.h>

namespace lensprof {

// linear, srgb, gamma:G, film (an S curve like that of film), or emor:a,b,... (EMoR coefficients); throws
// std::invalid_argument with the reason for other words.
lensprof_response response_of_word(const std::string &word);

}  // namespace lensprof
