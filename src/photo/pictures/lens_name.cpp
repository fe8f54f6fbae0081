#include "photo/pictures/lens_name.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <optional>

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

std::string xmp_text(const Exiv2::XmpData &xmp, const char *key) {
    const auto datum = std::find_if(xmp.begin(), xmp.end(), [&](const auto &entry) { return entry.key() == key; });
    return datum == xmp.end() ? std::string() : clean_text(datum->toString());
}

struct FocalRange {
    double shortest, longest;  // mm
};

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

// Canon's focal lengths are integers in a unit that is stated, too: longest, shortest, units per mm.
std::optional<FocalRange> canon_range(const Exiv2::ExifData &exif) {
    const auto datum = exif.findKey(Exiv2::ExifKey("Exif.CanonCs.Lens"));
    if (datum == exif.end() || datum->count() < 3 || datum->toLong(2) <= 0 || datum->toLong(1) <= 0)
        return std::nullopt;
    const double units = datum->toFloat(2);
    return FocalRange{datum->toFloat(1) / units, datum->toFloat(0) / units};
}

// aux:LensInfo "24/1 70/1 0/0 0/0": shortest and longest focal length, and f-numbers.
std::optional<FocalRange> adobe_range(const Exiv2::XmpData &xmp) {
    const std::string text = xmp_text(xmp, "Xmp.aux.LensInfo");
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

// What Exiv2 prints for the first number that means a lens: its name, a list of names or, if it does not know it or
// several share it, the number.
std::string print_number(const Exiv2::ExifData &exif) {
    std::string unknown;
    for (const char *key : {"Exif.CanonCs.LensType", "Exif.NikonLd1.LensIDNumber", "Exif.NikonLd2.LensIDNumber",
                            "Exif.NikonLd3.LensIDNumber", "Exif.Pentax.LensType", "Exif.PentaxDng.LensType",
                            "Exif.Minolta.LensID", "Exif.SonyMinolta.LensID", "Exif.Sony1.LensID", "Exif.Sony2.LensID",
                            "Exif.OlympusEq.LensType", "Exif.Panasonic.LensType", "Exif.Samsung2.LensType"}) {
        const auto datum = exif.findKey(Exiv2::ExifKey(key));
        if (datum == exif.end() || datum->count() == 0) continue;
        const std::string name = clean_text(datum->print(&exif));
        if (is_name(name)) return name;
        const bool is_number = !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
        if (unknown.empty() && is_number && name != "0" && name != "65535") unknown = name;
    }
    return unknown;
}

void add_numbers(Exiv2::ExifData &exif, const char *key, Exiv2::TypeId type, const std::string &numbers) {
    const auto value = Exiv2::Value::create(type);
    if (value->read(numbers) == 0) exif.add(Exiv2::ExifKey(key), value.get());
}

// Adobe stores the maker's number, which means what it means in the maker notes. Nikon's is only the first of the eight
// numbers that identify a lens.
std::string print_adobe_number(const Exiv2::ExifData &exif, const Exiv2::XmpData &xmp) {
    const std::string number = xmp_text(xmp, "Xmp.aux.LensID"), maker = read_text(exif, "Exif.Image.Make");
    if (number.empty() || number.find_first_not_of("0123456789 ") != std::string::npos) return {};
    static const struct {
        const char *maker, *key;
        Exiv2::TypeId type;
    } keys[] = {{"Canon", "Exif.CanonCs.LensType", Exiv2::unsignedShort},
                {"SONY", "Exif.Sony2.LensID", Exiv2::unsignedLong}};
    for (const auto &entry : keys) {
        if (maker.compare(0, std::strlen(entry.maker), entry.maker) != 0) continue;
        Exiv2::ExifData exif_of_maker;
        exif_of_maker["Exif.Image.Make"] = maker;
        exif_of_maker["Exif.Image.Model"] = read_text(exif, "Exif.Image.Model");
        add_numbers(exif_of_maker, entry.key, entry.type, number);
        if (const auto range = adobe_range(xmp))  // by which Exiv2 distinguishes lenses of one number
            add_numbers(exif_of_maker, "Exif.CanonCs.Lens", Exiv2::unsignedShort,
                        std::to_string(std::lround(range->longest)) + " " + std::to_string(std::lround(range->shortest))
                            + " 1");
        return print_number(exif_of_maker);
    }
    return {};
}

// Whether what Exiv2 printed is one lens, with the stated focal lengths.
bool is_one_lens(const std::string &name, const std::optional<FocalRange> &stated) {
    return is_in_words(name) && !is_list(name) && has_range(name, stated);
}

}  // namespace

LensName read_lens(const Exiv2::ExifData &exif, const Exiv2::XmpData &xmp) {
    const std::string model = read_text(exif, "Exif.Photo.LensModel"), canon = read_text(exif, "Exif.Canon.LensModel"),
                      adobe = xmp_text(xmp, "Xmp.aux.Lens"), cipa = xmp_text(xmp, "Xmp.exifEX.LensModel");
    for (const std::string &name : {model, canon})
        if (is_in_words(name)) return {name, ""};
    const std::string by_number = print_number(exif), by_adobe_number = print_adobe_number(exif, xmp);
    if (is_one_lens(by_number, canon_range(exif))) return {by_number, ""};
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
