#include "cli/fitting/lens_settings.hpp"

#include <cmath>
#include <cstring>

#include "cli/report/report.hpp"

namespace lensprof {
namespace {

constexpr double kSameStop = 0.17;       // log2 of f-numbers squared: a sixth of a stop is how EXIF rounds
constexpr double kSameFocal = 0.02;      // relative
constexpr double kSameExtension = 0.02;  // focal length over focus distance: what focusing moves the falloff by

bool are_known(double a, double b) { return a != LENSPROF_UNKNOWN && b != LENSPROF_UNKNOWN; }

// As far as both keys say.
bool is_same_setting(const lensprof_profile_key &a, const lensprof_profile_key &b) {
    if (*a.lens && *b.lens && std::strcmp(a.lens, b.lens) != 0) return false;
    if (are_known(a.aperture, b.aperture) && std::fabs(2.0 * std::log2(a.aperture / b.aperture)) > kSameStop)
        return false;
    if (!are_known(a.focal_mm, b.focal_mm)) return true;
    if (std::fabs(a.focal_mm / b.focal_mm - 1.0) > kSameFocal) return false;
    const auto extension = [](const lensprof_profile_key &key) { return 1e-3 * key.focal_mm / key.distance_m; };
    return !are_known(a.distance_m, b.distance_m) || std::fabs(extension(a) - extension(b)) < kSameExtension;
}

// What the command line states of all pictures tells none apart.
lensprof_profile_key stated_key(lensprof_profile_key key, const StoreOptions &store) {
    if (store.aperture != LENSPROF_UNKNOWN) key.aperture = store.aperture;
    if (store.focal != LENSPROF_UNKNOWN) key.focal_mm = store.focal;
    if (store.distance != LENSPROF_UNKNOWN) key.distance_m = store.distance;
    if (!store.lens.empty()) *key.lens = '\0';
    return key;
}

}  // namespace

LensSettings lens_settings(const Project &project, const std::vector<PictureMetadata> &metadata,
                           const StoreOptions &store, bool one_lens) {
    LensSettings settings;
    std::vector<lensprof_profile_key> keys;
    for (const PictureMetadata &own : metadata) keys.push_back(stated_key(own.key, store));
    for (uint32_t i = 0; i < project.images.size(); i++) {
        uint32_t number = 0;
        const auto is_own = [&](uint32_t first) {
            return one_lens
                   || (project.images[i].vignetting_of == project.images[first].vignetting_of
                       && is_same_setting(keys[i], keys[first]));
        };
        while (number < settings.first.size() && !is_own(settings.first[number])) number++;
        if (number == settings.first.size()) settings.first.push_back(i);
        settings.of_image.push_back(number);
    }
    if (settings.first.size() > LENSPROF_SETTINGS_MAX)
        throw Failure(ExitCode::usage,
                      project.path + ": its pictures have " + std::to_string(settings.first.size())
                          + " lens settings, and " + std::to_string(LENSPROF_SETTINGS_MAX)
                          + " are the most of one fit; give fewer pictures, or --one-lens to take all as one");
    return settings;
}

std::string describe_setting(const lensprof_profile_key &key, const std::string &first_image) {
    const KeyParts parts = key_parts(key);
    std::string text;
    for (size_t part : {2, 3, 4})  // focal length, aperture, focus
        if (!parts[part].empty()) text += (text.empty() ? "" : ", ") + parts[part];
    return text.empty() ? "setting of " + first_image : text;
}

}  // namespace lensprof
