#include "photo/pictures/lens_name.hpp"

#include <cmath>
#include <cstdlib>
#include <optional>

#include "photo/pictures/exif_tags.hpp"
#include "photo/pictures/exif_value.hpp"

namespace lensprof {
namespace {

// "24.0-70.0 mm f/2.8", which fits many lenses.
bool is_numbers_alone(const std::string &name) {
    return name.find_first_not_of("0123456789.-/ mfF") == std::string::npos;
}

bool is_in_words(const std::string &name) { return is_name(name) && !is_numbers_alone(name); }

// Exiv2 prints all lenses that share a number.
bool is_list(const std::string &name) {
    return name.find(" | ") != std::string::npos || name.find(" or ") != std::string::npos
           || name.find(" *OR* ") != std::string::npos;
}

std::string xmp_text(const Xmp &xmp, const char *space, const char *name) { return clean_text(xmp.text(space, name)); }

bool is_same(const FocalRange &a, const FocalRange &b) {
    constexpr double tolerance = 0.05;  // relative: the rounding of names
    return std::fabs(a.shortest / b.shortest - 1.0) < tolerance && std::fabs(a.longest / b.longest - 1.0) < tolerance;
}

// Of "Canon EF 24-70mm f/2.8L USM": the number before "mm", and one before a hyphen.
std::optional<FocalRange> range_of_name(const std::string &name) {
    const size_t unit = name.find("mm");
    if (unit == std::string::npos || unit == 0) return std::nullopt;
    const size_t before = name.find_last_not_of("0123456789.- ", unit - 1);
    const std::string numbers = name.substr(before == std::string::npos ? 0 : before + 1);
    char *end = nullptr;
    const double first = std::strtod(numbers.c_str(), &end);
    const double second = *end == '-' ? std::strtod(end + 1, nullptr) : first;
    return first > 0 && second >= first ? std::optional<FocalRange>({first, second}) : std::nullopt;
}

// aux:LensInfo "24/1 70/1 0/0 0/0": shortest and longest focal length, and f-numbers.
std::optional<FocalRange> adobe_range(const Xmp &xmp) {
    const std::string text = xmp_text(xmp, xmp_names::adobe_lens, "LensInfo");
    double value[2];
    const char *at = text.c_str();
    for (double &number : value) {
        char *end = nullptr;
        number = std::strtod(at, &end);
        if (*end == '/') number /= std::strtod(end + 1, &end);
        at = end;
    }
    return value[0] > 0 && value[1] >= value[0] && std::isfinite(value[1])
               ? std::optional<FocalRange>({value[0], value[1]})
               : std::nullopt;
}

// Whether a lens has the stated focal lengths, which a converter changes.
bool has_range(const std::string &name, const std::optional<FocalRange> &stated) {
    const auto range = range_of_name(name);
    return !range || !stated || name.find('+') != std::string::npos || is_same(*range, *stated);
}

// Adobe stores the maker's number, which means what it means in the maker notes. Nikon's is only the first of the eight
// numbers that identify a lens.
std::string lens_of_adobe_number(const Exif &exif, const Xmp &xmp) {
    const std::string number = xmp_text(xmp, xmp_names::adobe_lens, "LensID");
    if (number.empty() || number.find_first_not_of("0123456789 ") != std::string::npos) return {};
    return lens_of_number(read_text(exif, exif_tags::make), read_text(exif, exif_tags::model), number,
                          adobe_range(xmp));
}

// Whether what Exiv2 printed is one lens, with the stated focal lengths.
bool is_one_lens(const std::string &name, const std::optional<FocalRange> &stated) {
    return is_in_words(name) && !is_list(name) && has_range(name, stated);
}

}  // namespace

LensName read_lens(const Exif &exif, const Xmp &xmp, const MakerNotes &notes) {
    const std::string model = read_text(exif, exif_tags::lens_model), &canon = notes.lens_model,
                      adobe = xmp_text(xmp, xmp_names::adobe_lens, "Lens"),
                      cipa = xmp_text(xmp, xmp_names::exif_2, "LensModel");
    for (const std::string &name : {model, canon})
        if (is_in_words(name)) return {name, ""};
    const std::string &by_number = notes.lens_of_number, by_adobe_number = lens_of_adobe_number(exif, xmp);
    if (is_one_lens(by_number, notes.lens_range)) return {by_number, ""};
    for (const std::string &name : {cipa, adobe})
        if (is_in_words(name)) return {name, ""};
    if (is_one_lens(by_adobe_number, adobe_range(xmp))) return {by_adobe_number, ""};
    LensName lens;
    for (const std::string &name : {model, by_number, canon, cipa, adobe})
        if (lens.name.empty() && is_name(name) && is_numbers_alone(name)) lens.name = name;
    for (const std::string &text : {by_number, by_adobe_number, lens.name})
        if (lens.ambiguous.empty()) lens.ambiguous = text;
    return lens;
}

}  // namespace lensprof
