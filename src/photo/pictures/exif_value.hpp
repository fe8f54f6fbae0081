// Numbers in EXIF, in double precision, and texts.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>

#include <exiv2/exiv2.hpp>

namespace lensprof {

// NaN if there is no value.
double number(const Exiv2::Exifdatum &datum);

// The first existing key; NaN if none exists.
double read_number(const Exiv2::ExifData &exif, std::initializer_list<const char *> keys);

// A text as valid UTF-8: up to its first NUL, without surrounding blanks.
std::string clean_text(const std::string &raw);

// Empty if there is no value. The text may be stored as ASCII, BYTE or UNDEFINED.
std::string read_text(const Exiv2::ExifData &exif, const char *key);

// Excludes what cameras write for an unknown lens, and what Exiv2 prints if it knows only the number.
bool is_name(const std::string &text);

// Whether the value is above 0 and below the limit; false for NaN.
std::optional<double> in_range(double value, double below);

// Writes the value as the fraction with small terms that is within 1e-9 of it; values that are not positive are
// skipped.
void set_rational(Exiv2::ExifData &exif, const char *key, double value);

}  // namespace lensprof
