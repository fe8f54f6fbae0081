#include "formats/code/code_text.hpp"

#include <cmath>

#include <lensprof/base.h>

#include "formats/text/text.hpp"

namespace lensprof {
namespace {

// Bytes of the character at the beginning; 0 if that is not well-formed.
size_t character_bytes(std::string_view text) {
    for (size_t bytes = 1; bytes <= 4 && bytes <= text.size(); bytes++)
        if (find_not_utf8(text.substr(0, bytes)) == bytes) return bytes;
    return 0;
}

// Whether a character may stand in a comment. Of others than ASCII: no controls (U+0080 to U+009F), no separators of
// lines and marks of direction (U+200E to U+202E but for dashes and quotes, U+2066 to U+2069), no byte order mark.
bool is_plain(std::string_view character) {
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(character[i]); };
    if (character.size() == 1) return byte(0) >= ' ' && byte(0) != 127 && byte(0) != '\\';
    if (character.size() == 2) return byte(0) != 0xC2 || byte(1) >= 0xA0;
    if (character.size() == 4) return true;
    if (byte(0) == 0xEF) return byte(1) != 0xBB || byte(2) != 0xBF;
    if (byte(0) != 0xE2) return true;
    const bool is_mark =
        byte(1) == 0x80 && (byte(2) == 0x8E || byte(2) == 0x8F || (byte(2) >= 0xA8 && byte(2) <= 0xAE));
    return !is_mark && !(byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xA9);
}

// Pairs that begin or end comments, or begin trigraphs of C.
bool is_pair(char a, char b) {
    return (a == '/' && (b == '/' || b == '*')) || (a == '*' && b == '/') || (a == '?' && b == '?');
}

std::string known(const char *name, double value, const char *unit) {
    return value == LENSPROF_UNKNOWN ? std::string() : std::string(", ") + name + number_text(value) + unit;
}

}  // namespace

std::string comment_text(std::string_view text) {
    std::string safe;
    while (!text.empty()) {
        const size_t bytes = character_bytes(text);
        const std::string_view character = text.substr(0, bytes ? bytes : 1);
        if (!bytes || !is_plain(character))
            safe += '_';
        else {
            if (!safe.empty() && is_pair(safe.back(), character[0])) safe += ' ';
            safe += character;
        }
        text.remove_prefix(character.size());
    }
    return safe;
}

std::string name_of_profile(const lensprof_profile_key &key) {
    std::string name = key.camera_maker;
    if (*key.camera_model) name += (name.empty() ? "" : " ") + std::string(key.camera_model);
    if (*key.lens) name += (name.empty() ? "" : ", ") + std::string(key.lens);
    name += known("", key.focal_mm, " mm") + known("f/", key.aperture, "");
    if (std::isinf(key.distance_m))
        name += ", infinity";
    else
        name += known("", key.distance_m, " m");
    return name.substr(0, 2) == ", " ? name.substr(2) : name;
}

std::vector<std::string> head_lines(const lensprof_profile &profile, std::string_view what) {
    static constexpr const char *kPictures[] = {"raw (linear)", "rendered by the camera",
                                                "rendered, and corrected by the camera"};
    const std::string name = name_of_profile(profile.key);
    return {std::string("lensprof ") + lensprof_version() + ": " + std::string(what),
            "Profile: " + (name.empty() ? "no camera and lens named" : comment_text(name)),
            std::string("Pictures: ") + kPictures[profile.key.processing]};
}

}  // namespace lensprof
