// Names of lenses: from EXIF to Lensfun's database. The rules are those by which most lenses of a maker are named there
// (version 0.3.3); the words that cameras leave out cannot be restored.
#include "formats/lensfun_names.hpp"

#include <algorithm>
#include <string_view>

#include "formats/text/xml.hpp"

namespace lensprof {
namespace {

constexpr const char *kGeneric = "Generic";  // which Lensfun's cameras with exchangeable lenses take

enum Aperture {
    kAsGiven,
    kSlash,
    kCapital
};  // f/2.8 or F2.8

// How lenses of a maker, or of one of its families, are named.
struct Rule {
    const char *start;  // of the name
    const char *maker;
    const char *front;  // what the model begins with, before `start` or (of a maker) instead of it
    Aperture aperture;
    const char *mount;       // of the family
    bool on_own;             // only on cameras of this maker: others name lenses so, too
    const char *upper = "";  // a word of EXIF that is not written in capitals
};

constexpr Rule kFamilies[] = {
    {"EF-S", "Canon", "Canon", kSlash, "Canon EF-S", false},
    {"EF-M", "Canon", "Canon", kSlash, "Canon EF-M", false},
    {"EF", "Canon", "Canon", kSlash, "Canon EF", false},
    {"TS-E", "Canon", "Canon", kSlash, "Canon EF", false},
    {"MP-E", "Canon", "Canon", kSlash, "Canon EF", false},
    {"RF-S", "Canon", "Canon", kCapital, "Canon RF", false},
    {"RF", "Canon", "Canon", kCapital, "Canon RF", false},
    {"NIKKOR Z", "Nikon", "", kSlash, "Nikon Z", false},
    {"1 Nikkor", "Nikon", "", kSlash, "Nikon CX", false},
    {"1 NIKKOR", "Nikon", "", kSlash, "Nikon CX", false, "NIKKOR"},
    {"AF-S", "Nikon", "Nikon", kSlash, "Nikon F AF", false, "NIKKOR"},
    {"AF-P", "Nikon", "Nikon", kSlash, "Nikon F AF", false, "NIKKOR"},
    {"AF", "Nikon", "Nikon", kSlash, "Nikon F AF", true, "NIKKOR"},
    {"AI-S", "Nikon", "Nikon", kSlash, "Nikon F AI-S", false, "NIKKOR"},
    {"AI", "Nikon", "Nikon", kSlash, "Nikon F AI", true, "NIKKOR"},
    {"FE", "Sony", "", kSlash, "Sony E", true},
    {"E", "Sony", "", kSlash, "Sony E", true},
    {"VCL", "Sony", "", kAsGiven, "Sony E", true},
    {"DT", "Sony", "Sony", kSlash, "Sony Alpha", true},
    {"XF", "Fujifilm", "", kAsGiven, "Fujifilm X", false},
    {"XC", "Fujifilm", "", kAsGiven, "Fujifilm X", false},
    {"GF", "Fujifilm", "", kAsGiven, "Fujifilm G", false},
    {"M.Zuiko", "Olympus", "Olympus", kSlash, "Micro 4/3 System", false},
    {"M.", "Olympus", "OLYMPUS", kAsGiven, "Micro 4/3 System", false},
    {"Zuiko Digital", "Olympus", "Olympus", kSlash, "4/3 System", false},
    {"LEICA DG", "Panasonic", "", kAsGiven, "Micro 4/3 System", false},
    {"LUMIX S", "Panasonic", "", kAsGiven, "Leica L", false},
    {"LUMIX G", "Panasonic", "", kAsGiven, "Micro 4/3 System", false},
    {"Lumix G", "Panasonic", "", kSlash, "Micro 4/3 System", false},
    {"DG", "Leica", "Leica", kSlash, "Micro 4/3 System", false},
    {"smc P", "Pentax", "", kSlash, "", false, "PENTAX"},
    {"HD P", "Pentax", "", kSlash, "", false, "PENTAX"},
    {"Batis", "Zeiss", "Zeiss", kAsGiven, "Sony E", false},
    {"Loxia", "Zeiss", "Zeiss", kAsGiven, "Sony E", false},
    {"Touit", "Zeiss", "", kAsGiven, "", false},
    {"Milvus", "Zeiss", "Zeiss", kAsGiven, "", false},
    {"Otus", "Zeiss", "Zeiss", kSlash, "", false},
    {"NX", "Samsung", "Samsung", kSlash, "Samsung NX", false},
    {"AF", "Samyang", "SAMYANG", kAsGiven, "", true},
};

constexpr Rule kMakers[] = {
    {"Canon", "Canon", "Canon", kSlash, "", false},
    {"Nikon", "Nikon", "Nikon", kSlash, "", false, "NIKKOR"},
    {"Sony", "Sony", "Sony", kSlash, "", false},
    {"Fujifilm", "Fujifilm", "", kAsGiven, "", false},
    {"Olympus", "Olympus", "Olympus", kSlash, "", false},
    {"Panasonic", "Panasonic", "", kAsGiven, "", false},
    {"Pentax", "Pentax", "", kSlash, "", false, "PENTAX"},
    {"Ricoh", "Pentax", "", kSlash, "", false, "PENTAX"},
    {"Konica Minolta", "Konica Minolta", "", kSlash, "", false},
    {"Minolta", "Minolta", "Minolta", kSlash, "", false},
    {"Samsung", "Samsung", "Samsung", kSlash, "", false},
    {"Leica", "Leica", "", kAsGiven, "", false},
    {"Carl Zeiss", "Zeiss", "Carl Zeiss", kAsGiven, "", false},
    {"Zeiss", "Zeiss", "Zeiss", kAsGiven, "", false},
    {"Sigma", "Sigma", "Sigma", kSlash, "", false},
    {"Tamron", "Tamron", "Tamron", kSlash, "", false},
    {"Tokina", "Tokina", "Tokina", kSlash, "", false},
    {"Samyang", "Samyang", "Samyang", kSlash, "", false},
    {"Voigtl\u00e4nder", "Voigtl\u00e4nder", "Voigtl\u00e4nder", kSlash, "", false},
    {"Schneider", "Schneider", "Schneider", kSlash, "", false},
    {"Mamiya", "Mamiya", "Mamiya", kSlash, "", false},
};

// Words by which names without a maker are those of other makers' lenses.
constexpr struct {
    const char *word, *maker;
} kWords[] = {
    {" | ", "Sigma"},    {" DG ", "Sigma"},   {" DC ", "Sigma"},     {" DN", "Sigma"},
    {" EX ", "Sigma"},   {" Di ", "Tamron"},  {" Di II", "Tamron"},  {" Di-II", "Tamron"},
    {" XR ", "Tamron"},  {" LD ", "Tamron"},  {"AT-X", "Tokina"},    {"ATX", "Tokina"},
    {" UMC", "Samyang"}, {" NCS", "Samyang"}, {"Distagon", "Zeiss"}, {"Planar", "Zeiss"},
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

bool begins_with(std::string_view text, std::string_view start) { return text.substr(0, start.size()) == start; }

// The rule of the maker whose name the text begins with, in any case; NULL for none.
const Rule *maker_at_start(const std::string &text) {
    for (const Rule &rule : kMakers) {
        const std::string_view start = rule.start;
        const bool same = text.size() >= start.size()
                          && std::equal(start.begin(), start.end(), text.begin(),
                                        [](char a, char b) { return lower(a) == lower(b); });
        if (same && (text.size() == start.size() || text[start.size()] == ' ')) return &rule;
    }
    return nullptr;
}

const Rule *rule_of_maker(std::string_view maker) {
    for (const Rule &rule : kMakers)
        if (rule.maker == maker) return &rule;
    return nullptr;
}

// The family with which a name begins, of this maker or, without one, of any.
const Rule *family_of(std::string_view lens, std::string_view own, std::string_view camera) {
    for (const Rule &rule : kFamilies) {
        const std::string_view start = rule.start;
        const bool ends = lens.size() == start.size() || !is_letter(start.back()) || start.back() == 'P'
                          || !is_letter(lens[std::min(start.size(), lens.size() - 1)]);
        const bool allowed = !own.empty() ? own == rule.maker : !rule.on_own || camera == rule.maker || camera.empty();
        if (begins_with(lens, start) && ends && allowed) return &rule;
    }
    return nullptr;
}

// Tamron's numbers of its lenses, such as A071, at the end.
bool has_tamron_number(std::string_view lens) {
    return lens.size() > 5 && lens[lens.size() - 5] == ' '
           && std::string_view("ABF").find(lens[lens.size() - 4]) != std::string_view::npos
           && lens[lens.size() - 3] == '0' && is_digit(lens[lens.size() - 2]) && is_digit(lens.back());
}

const char *maker_by_words(const std::string &lens) {
    if (has_tamron_number(lens)) return "Tamron";
    for (const auto &known : kWords)
        if (lens.find(known.word) != std::string::npos) return known.maker;
    return nullptr;
}

// An f-number with what its form begins with: F2.8, f/2.8, F/2.8; not Tamron's F012.
std::string with_aperture(const std::string &lens, Aperture form) {
    std::string text;
    for (size_t i = 0; i < lens.size(); i++) {
        const bool begins = lower(lens[i]) == 'f' && i > 0 && lens[i - 1] == ' ';
        const size_t number = i + 1 + (i + 1 < lens.size() && (lens[i + 1] == '/' || lens[i + 1] == '_'));
        const bool is_number = begins && number < lens.size() && is_digit(lens[number])
                               && !(lens[number] == '0' && number + 1 < lens.size() && is_digit(lens[number + 1]));
        if (form == kAsGiven || !is_number) {
            text += lens[i];
            continue;
        }
        text += form == kSlash ? "f/" : "F";
        i = number - 1;
    }
    return text;
}

// "RF24-105mm F4 L" to "RF 24-105mm F4L", as on the lens.
std::string with_canon_blanks(std::string lens, size_t prefix) {
    if (prefix < lens.size() && is_digit(lens[prefix])) lens.insert(prefix, " ");
    const size_t at = lens.find(" L ");
    if (at != std::string::npos && at > 0 && is_digit(lens[at - 1])) lens.erase(at, 1);
    return lens;
}

std::string spelled(std::string lens, const Rule &rule) {
    const size_t upper = *rule.upper ? lens.find(rule.upper) : std::string::npos;
    if (upper != std::string::npos)
        std::transform(lens.begin() + ptrdiff_t(upper) + 1,
                       lens.begin() + ptrdiff_t(upper + std::string_view(rule.upper).size()),
                       lens.begin() + ptrdiff_t(upper) + 1, lower);
    lens = with_aperture(lens, rule.aperture);
    const bool has_front = !*rule.front || begins_with(lens, rule.front);
    return has_front ? lens : rule.front + (" " + lens);
}

}  // namespace

LensfunName lensfun_name(const std::string &lens, const std::string &camera_maker) {
    const std::string name = one_line(lens);
    const Rule *own = maker_at_start(name), *camera = maker_at_start(one_line(camera_maker));
    const std::string rest = own && name.size() > std::string_view(own->start).size()
                                 ? name.substr(std::string_view(own->start).size() + 1)
                                 : name;
    const std::string camera_name = camera ? camera->maker : camera_maker;
    const Rule *shown = family_of(name, "", camera_name);
    const char *other = own || (shown && !shown->on_own) ? nullptr : maker_by_words(name);
    if (other) {
        const bool as_given = shown || name.find(" | ") != std::string::npos;
        return {other, as_given ? name : spelled(name, *rule_of_maker(other)), ""};
    }
    const Rule *family = family_of(name, "", own ? "-" : camera_name);
    const std::string &model = family ? name : rest;
    if (!family) family = family_of(rest, own ? own->maker : "", camera_name);
    if (family && family->maker == std::string_view("Canon"))
        return {"Canon", spelled(with_canon_blanks(model, std::string_view(family->start).size()), *family),
                family->mount};
    if (family) return {family->maker, spelled(model, *family), family->mount};
    if (own && rest.find(" | ") != std::string::npos) return {own->maker, rest, ""};
    const Rule *maker = own ? own : camera;
    if (maker) return {maker->maker, spelled(rest, *maker), ""};
    return {camera_maker.empty() ? name.substr(0, name.find(' ')) : one_line(camera_maker), name, ""};
}

std::string lensfun_mount(const LensfunName &name, const std::string &camera_mount) {
    if (!name.mount.empty()) return name.mount;
    if (camera_mount == "Canon EF-S" && name.maker != "Canon") return "Canon EF";
    return camera_mount.empty() ? kGeneric : camera_mount;
}

std::string comparable_name(const std::string &lens) {
    std::string text;
    for (size_t i = 0; i < lens.size(); i++) {
        const char c = lens[i];
        const bool in_number = i > 0 && is_digit(lens[i - 1]) && i + 1 < lens.size() && is_digit(lens[i + 1]);
        const bool is_whole =
            c == '.' && in_number && lens[i + 1] == '0' && !(i + 2 < lens.size() && is_digit(lens[i + 2]));
        if (is_whole)
            i++;
        else if (is_letter(c) || is_digit(c) || c == '*' || static_cast<unsigned char>(c) >= 128
                 || (in_number && (c == '.' || c == '-')))
            text += lower(c);
    }
    return text;
}

}  // namespace lensprof
