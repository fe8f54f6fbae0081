#include "photo/cards/card_names.hpp"

#include <cmath>
#include <filesystem>
#include <regex>
#include <vector>

#include "photo/base/library.hpp"

namespace lensprof {
namespace {

constexpr double metres_of_infinity = INFINITY;

// A number within the range of a key; unknown for another.
double positive(const std::string &text) {
    try {
        const double value = std::stod(text);
        return std::isfinite(value) && value > 0.0 && value < 1e5 ? value : LENSPROF_UNKNOWN;
    } catch (const std::exception &) {
        return LENSPROF_UNKNOWN;
    }
}

void fill(double &field, double value) {
    if (field == LENSPROF_UNKNOWN) field = value;
}

// "Canon_EF_24-70mm_f__2.8L" -> "Canon EF 24-70mm f/2.8L".
std::string lens_of(const std::string &name) {
    return std::regex_replace(std::regex_replace(name, std::regex("__"), "/"), std::regex("_"), " ");
}

// Lens--FOCALmm--APERTURE, or without the lens, with anything after it that is not a digit. Returns whether the name
// has this form.
bool read_three_parts(const std::string &name, lensprof_profile_key &key) {
    static const std::regex form(R"((?:(.+)--)?(\d+(?:\.\d+)?)mm--[fF]?/?(\d+(?:\.\d+)?)(?![\d.]).*)");
    std::smatch parts;
    if (!std::regex_match(name, parts, form)) return false;
    if (parts[1].matched && !*key.lens) set_text(key.lens, sizeof key.lens, lens_of(parts[1]));
    fill(key.focal_mm, positive(parts[2]));
    fill(key.aperture, positive(parts[3]));
    return true;
}

// vignetting_10, vignetting_inf, vignetting.
bool read_distance_folder(const std::string &name, lensprof_profile_key &key) {
    static const std::regex form(R"(vignetting(?:_(\d+(?:\.\d+)?)m?|_.*)?)", std::regex::icase);
    std::smatch parts;
    if (!std::regex_match(name, parts, form)) return false;
    fill(key.distance_m, parts[1].matched ? positive(parts[1]) : metres_of_infinity);
    return true;
}

// One word of a name; false if names of settings have no such word.
bool read_word(const std::string &word, lensprof_profile_key &key) {
    static const std::regex focal(R"((\d+(?:\.\d+)?)mm)", std::regex::icase),
        aperture(R"(f\W?((?:[1-9]\d*|0(?=\.))(?:\.\d+)?))", std::regex::icase),
        distance(R"((\d+(?:\.\d+)?)m)", std::regex::icase), infinity("inf|infinity", std::regex::icase),
        other(R"(\d+|f0\d+|\d{4,5}k|alsc|card|flat|white|wall|sky|img|image|dsc|dscf|shot|raw|field)",
              std::regex::icase);
    std::smatch number;
    if (std::regex_match(word, number, focal)) return fill(key.focal_mm, positive(number[1])), true;
    if (std::regex_match(word, number, aperture)) return fill(key.aperture, positive(number[1])), true;
    if (std::regex_match(word, number, distance)) return fill(key.distance_m, positive(number[1])), true;
    if (std::regex_match(word, infinity)) return fill(key.distance_m, metres_of_infinity), true;
    return std::regex_match(word, other);
}

// A name of such words alone: others may be that of a lens, whose numbers are not those of the setting.
void read_words(const std::string &name, lensprof_profile_key &key) {
    static const std::regex separators("[ _-]+");
    lensprof_profile_key read = key;
    for (std::sregex_token_iterator word(name.begin(), name.end(), separators, -1), end; word != end; ++word)
        if (word->length() && !read_word(*word, read)) return;
    key = read;
}

// A word of a name with others of any kind.
void read_temperature(const std::string &name, lensprof_profile_key &key) {
    static const std::regex form(R"((?:^|[ _.-])([1-9]\d{3}|1\d{4})K(?![A-Za-z0-9]))", std::regex::icase);
    std::smatch number;
    if (std::regex_search(name, number, form)) fill(key.color_temperature_k, positive(number[1]));
}

}  // namespace

lensprof_profile_key setting_of_names(const std::string &path) {
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    const std::filesystem::path file(path);
    std::vector<std::string> names{file.stem().string()};
    for (std::filesystem::path folder = file.parent_path(); folder.has_filename(); folder = folder.parent_path())
        names.push_back(folder.filename().string());
    for (size_t n = 0; n < names.size(); n++) {
        read_temperature(names[n], key);
        if (n == 0 ? read_three_parts(names[n], key) : read_distance_folder(names[n], key)) continue;
        read_words(names[n], key);
    }
    return key;
}

}  // namespace lensprof
