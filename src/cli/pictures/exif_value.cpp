#include "cli/pictures/exif_value.hpp"

#include <cmath>
#include <cstdint>

namespace lensprof {

double number(const Exiv2::Exifdatum &datum) {
    if (datum.count() == 0) return NAN;
    if (const auto *value = dynamic_cast<const Exiv2::URationalValue *>(&datum.value()))
        return static_cast<double>(value->value_[0].first) / value->value_[0].second;
    if (const auto *value = dynamic_cast<const Exiv2::RationalValue *>(&datum.value()))
        return static_cast<double>(value->value_[0].first) / value->value_[0].second;
    return static_cast<double>(datum.toFloat());
}

double read_number(const Exiv2::ExifData &exif, std::initializer_list<const char *> keys) {
    for (const char *key : keys) {
        const auto datum = exif.findKey(Exiv2::ExifKey(key));
        if (datum != exif.end()) return number(*datum);
    }
    return NAN;
}

std::optional<double> in_range(double value, double below) {
    return value > 0 && value < below ? std::optional<double>(value) : std::nullopt;
}

namespace {

// The fraction with small terms that is within 1e-9 of the value, by continued fractions.
Exiv2::URational to_rational(double value) {
    double p0 = 0, q0 = 1, p1 = 1, q1 = 0, rest = value;
    for (int i = 0; i < 40; ++i) {
        const double integer = std::floor(rest);
        const double p2 = integer * p1 + p0, q2 = integer * q1 + q0;
        if (p2 > 4e9 || q2 > 4e9) break;
        p0 = p1, q0 = q1, p1 = p2, q1 = q2;
        if (std::fabs(p1 / q1 - value) <= 1e-9 * value || rest == integer) break;
        rest = 1 / (rest - integer);
    }
    return {static_cast<uint32_t>(p1), static_cast<uint32_t>(q1)};
}

}  // namespace

void set_rational(Exiv2::ExifData &exif, const char *key, double value) {
    if (value > 0 && value < 4e9) exif[key] = to_rational(value);
}

}  // namespace lensprof
