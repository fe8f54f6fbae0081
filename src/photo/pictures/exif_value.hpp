// Numbers in EXIF, in double precision, and texts.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

#include "photo/pictures/exif_fields.hpp"

namespace lensprof {

// NaN if there is no such value, or it is a text. A fraction with the denominator 0 is infinite or NaN.
double number_of(const ExifField *field, TiffByteOrder order, size_t index = 0);

// The first existing tag; NaN if none exists.
double read_number(const Exif &exif, std::initializer_list<ExifTag> tags);

// Numerator and denominator of a fraction without sign.
std::optional<std::pair<uint32_t, uint32_t>> read_fraction(const Exif &exif, ExifTag tag);

// A text as valid UTF-8: up to its first NUL, without surrounding blanks.
std::string clean_text(const std::string &raw);

// Empty if there is no value. The text may be stored as ASCII, BYTE or UNDEFINED; integers are printed.
std::string read_text(const Exif &exif, ExifTag tag);

// Excludes what cameras write for an unknown lens, and what Exiv2 prints if it knows only the number.
bool is_name(const std::string &text);

// Whether the value is above 0 and below the limit; false for NaN.
std::optional<double> in_range(double value, double below);

// Writes the value as the fraction with small terms that is within 1e-9 of it; values that are not positive are
// skipped.
void set_rational(Exif &exif, ExifTag tag, double value);
void set_fraction(Exif &exif, ExifTag tag, uint32_t numerator, uint32_t denominator);

}  // namespace lensprof
