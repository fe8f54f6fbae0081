// Numbers as text, whatever the process locale.
#pragma once

#include <string>
#include <string_view>

namespace lensprof {

// The whole of `text` as a finite number.
bool read_number(std::string_view text, double &value);

// The same as a whole number within [low, high].
bool read_whole(std::string_view text, double low, double high, double &value);

// Shortest decimal form that reads back as the same number.
std::string number_text(double value);

// The same of single precision, always with "." or "e".
std::string float_text(double value);

// The same without exponent.
std::string fixed_text(double value);

}  // namespace lensprof
