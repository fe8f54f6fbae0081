#include "photo/pictures/exif_value.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>

#include "photo/base/utf8.hpp"

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

// EXIF text is ASCII by the standard; text that is neither ASCII nor UTF-8 is treated as Latin-1. It ends at the first
// NUL, control characters become blanks, and surrounding blanks are removed.
std::string clean_text(const std::string &raw) {
    std::string text;
    for (size_t i = 0; i < raw.size() && raw[i] != '\0';) {
        const unsigned char c = static_cast<unsigned char>(raw[i]);
        const size_t length = utf8_length(raw, i);
        if (length == 0) {
            text += static_cast<char>(0xc0 | (c >> 6));
            text += static_cast<char>(0x80 | (c & 0x3f));
        } else if (c < 0x20 || c == 0x7f) {
            text += ' ';
        } else {
            text.append(raw, i, length);
        }
        i += std::max<size_t>(1, length);
    }
    const size_t first = text.find_first_not_of(' ');
    return first == std::string::npos ? std::string() : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// The bytes of text of any type: some programs write BYTE or UNDEFINED, the latter after a character code (EXIF 2.32
// section 4.6.5, UserComment).
static std::string raw_text(const Exiv2::Exifdatum &datum) {
    static const char ascii_code[8] = {'A', 'S', 'C', 'I', 'I', '\0', '\0', '\0'};
    const Exiv2::TypeId type = datum.typeId();
    if (type != Exiv2::unsignedByte && type != Exiv2::signedByte && type != Exiv2::undefined) return datum.toString();
    std::string text(static_cast<size_t>(datum.size()), '\0');
    datum.copy(reinterpret_cast<Exiv2::byte *>(&text[0]), Exiv2::littleEndian);
    return text.compare(0, sizeof ascii_code, ascii_code, sizeof ascii_code) == 0 ? text.substr(sizeof ascii_code)
                                                                                  : text;
}

std::string read_text(const Exiv2::ExifData &exif, const char *key) {
    const auto datum = exif.findKey(Exiv2::ExifKey(key));
    return datum == exif.end() || datum->count() == 0 ? std::string() : clean_text(raw_text(*datum));
}

bool is_name(const std::string &text) {
    static const char *const nothing[] = {"n/a",     "N/A",     "None",   "none", "Unknown", "unknown",
                                          "NO-LENS", "No lens", "0.0 mm", "0 mm", "Manual"};
    if (text.find_first_not_of("-0. ()") == std::string::npos) return false;
    if (text.front() == '(' && text.find_first_not_of("0123456789 ", 1) == text.size() - 1) return false;
    if (text.find_first_not_of("0123456789 ") == std::string::npos) return false;
    return std::none_of(std::begin(nothing), std::end(nothing),
                        [&](const char *start) { return text.compare(0, std::strlen(start), start) == 0; });
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
