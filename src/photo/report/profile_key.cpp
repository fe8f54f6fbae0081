// The key of a profile as text and as JSON.
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "photo/base/format.hpp"
#include "photo/report/report.hpp"

namespace lensprof {
namespace {

// Distances can be infinite, which JSON cannot represent.
Json distance_json(double distance_m) { return std::isinf(distance_m) ? Json("infinity") : number_or_null(distance_m); }

}  // namespace

const char *processing_name(uint32_t processing) {
    static const char *const names[] = {"raw", "jpeg", "corrected"};
    return processing <= LENSPROF_PROCESSING_CORRECTED ? names[processing] : "unknown";
}

Json key_json(const lensprof_profile_key &key) {
    return {{"camera_maker", key.camera_maker},
            {"camera_model", key.camera_model},
            {"lens", key.lens},
            {"unit", key.unit},
            {"crop_factor", number_or_null(key.crop_factor)},
            {"focal_mm", number_or_null(key.focal_mm)},
            {"aperture", number_or_null(key.aperture)},
            {"distance_m", distance_json(key.distance_m)},
            {"color_temperature_k", number_or_null(key.color_temperature_k)},
            {"processing", processing_name(key.processing)},
            {"style", key.style}};
}

std::string camera_name(const std::string &maker, const std::string &model) {
    if (maker.empty() || model.empty()) return maker + model;
    const std::string word = maker.substr(0, maker.find(' '));
    const auto is_same = [](char a, char b) {
        const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
        return lower(a) == lower(b);
    };
    const bool names_maker = model.size() >= word.size() && std::equal(word.begin(), word.end(), model.begin(), is_same)
                             && (model.size() == word.size() || model[word.size()] == ' ');
    return names_maker ? model : maker + " " + model;
}

KeyParts key_parts(const lensprof_profile_key &key) {
    KeyParts parts;
    parts[0] = camera_name(key.camera_maker, key.camera_model);
    parts[1] = key.lens;
    if (key.focal_mm != LENSPROF_UNKNOWN) parts[2] = format("%g mm", key.focal_mm);
    if (key.aperture != LENSPROF_UNKNOWN) parts[3] = format("f/%g", key.aperture);
    if (std::isinf(key.distance_m))
        parts[4] = "focus at infinity";
    else if (key.distance_m != LENSPROF_UNKNOWN)
        parts[4] = format("focus at %g m", key.distance_m);
    parts[5] = processing_name(key.processing);
    return parts;
}

std::string spell_part(const KeyParts &parts, size_t part) {
    static const char *const names[] = {"camera", "lens", "focal length", "aperture", "focus", "processing"};
    return parts[part].empty() ? std::string(names[part]) + " unknown" : parts[part];
}

std::string describe_key(const lensprof_profile_key &key) {
    const KeyParts parts = key_parts(key);
    std::string text = spell_part(parts, 0);
    for (size_t part = 1; part < parts.size(); part++) text += ", " + spell_part(parts, part);
    return text;
}

}  // namespace lensprof
