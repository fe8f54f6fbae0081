#include "photo/pictures/exif_value.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>

#include "photo/base/utf8.hpp"

namespace lensprof {

namespace {

// An integer of up to four bytes; `size` with its sign.
double integer_of(const uint8_t *bytes, size_t size, bool is_signed, TiffByteOrder order) {
    const uint32_t value = order.get(bytes, size);
    const uint64_t range = uint64_t(1) << (8 * size);
    return is_signed && value >= range / 2 ? static_cast<double>(value) - static_cast<double>(range) : value;
}

double floating_of(const uint8_t *bytes, size_t size, TiffByteOrder order) {
    uint64_t bits = order.get(bytes, 4);
    if (size == 4) {
        const uint32_t half = static_cast<uint32_t>(bits);
        float value;
        std::memcpy(&value, &half, sizeof value);
        return static_cast<double>(value);
    }
    const uint64_t other = order.get(bytes + 4, 4);
    bits = order.big ? bits << 32 | other : other << 32 | bits;
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

}  // namespace

double number_of(const ExifField *field, TiffByteOrder order, size_t index) {
    enum : uint16_t {
        signed_byte = 6,
        signed_short = 8,
        signed_long = 9,
        signed_rational = 10,
        single = 11,
        twice = 12
    };
    const size_t size = field ? tiff_type_bytes(field->type) : 0;
    if (size == 0 || field->type == exif_ascii || field->bytes.size() / size <= index) return NAN;
    const uint8_t *bytes = &field->bytes[index * size];
    const bool is_signed = field->type == signed_byte || field->type == signed_short || field->type == signed_long
                           || field->type == signed_rational;
    if (field->type == single || field->type == twice) return floating_of(bytes, size, order);
    if (size < 8) return integer_of(bytes, size, is_signed, order);
    return integer_of(bytes, 4, is_signed, order) / integer_of(bytes + 4, 4, is_signed, order);
}

double read_number(const Exif &exif, std::initializer_list<ExifTag> tags) {
    for (const ExifTag tag : tags)
        if (const ExifField *field = exif.find(tag)) return number_of(field, exif.order);
    return NAN;
}

std::optional<std::pair<uint32_t, uint32_t>> read_fraction(const Exif &exif, ExifTag tag) {
    const ExifField *field = exif.find(tag);
    if (!field || field->type != exif_rational || field->bytes.size() < 8) return std::nullopt;
    return std::make_pair(exif.order.get(&field->bytes[0], 4), exif.order.get(&field->bytes[4], 4));
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
std::string read_text(const Exif &exif, ExifTag tag) {
    static const char ascii_code[8] = {'A', 'S', 'C', 'I', 'I', '\0', '\0', '\0'};
    const ExifField *field = exif.find(tag);
    if (!field) return {};
    std::string text(field->bytes.begin(), field->bytes.end());
    if (const size_t size = tiff_type_bytes(field->type); size > 1) {
        text.clear();
        for (size_t i = 0; size < 8 && i < field->bytes.size() / size; ++i)
            text += (i ? " " : "") + std::to_string(std::llround(number_of(field, exif.order, i)));
    }
    if (text.compare(0, sizeof ascii_code, ascii_code, sizeof ascii_code) == 0) text.erase(0, sizeof ascii_code);
    return clean_text(text);
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
std::pair<uint32_t, uint32_t> to_rational(double value) {
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

void set_fraction(Exif &exif, ExifTag tag, uint32_t numerator, uint32_t denominator) {
    std::vector<uint8_t> bytes(8);
    exif.order.put(&bytes[0], 4, numerator);
    exif.order.put(&bytes[4], 4, denominator);
    exif.set(tag, exif_rational, 1, std::move(bytes));
}

void set_rational(Exif &exif, ExifTag tag, double value) {
    if (!(value > 0 && value < 4e9)) return;
    const auto [numerator, denominator] = to_rational(value);
    set_fraction(exif, tag, numerator, denominator);
}

}  // namespace lensprof
