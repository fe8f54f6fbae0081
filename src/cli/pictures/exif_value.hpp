// Numbers in EXIF, in double precision.
#pragma once

#include <initializer_list>
#include <optional>

#include <exiv2/exiv2.hpp>

namespace lensprof {

// NaN when there is no value.
double number(const Exiv2::Exifdatum &datum);

// The first of the keys that is there; NaN when none is.
double read_number(const Exiv2::ExifData &exif, std::initializer_list<const char *> keys);

// Above 0 and below the limit; NaN is not.
std::optional<double> in_range(double value, double below);

// As the fraction with small terms that is within 1e-9 of the value; a value that is no positive number is left out.
void set_rational(Exiv2::ExifData &exif, const char *key, double value);

}  // namespace lensprof
