// Reading and writing Lensfun databases in tests.
#pragma once

extern "C" {
#include "support.h"
}

#include <string>
#include <vector>

#include "formats/each_format.h"

struct Falloff {
    lensprof_profile_key key;
    lensprof_provenance provenance;
    lensprof_vignetting vignetting;
    uint32_t usable;
    lensprof_status valid;  // result of lensprof_profile_validate
};

struct Database {
    lensprof_status status;
    std::string error;
    std::vector<Falloff> entries;
};

inline lensprof_status collect(void *user, const lensprof_import_entry *entry) {
    const lensprof_profile &p = *entry->profile;
    static_cast<std::vector<Falloff> *>(user)->push_back(
        {p.key, p.provenance, p.vignetting[0], entry->usable, lensprof_profile_validate(&p)});
    return LENSPROF_OK;
}

// In memory of exactly its size, so that the address sanitizer detects reads beyond the end.
inline Database read_lensfun(const std::string &text, const char *source = "test.xml") {
    Database database{};
    lensprof_error error;
    std::vector<char> exact(text.begin(), text.end());
    database.status = lp_lensfun_read(exact.data(), exact.size(), source, collect, &database.entries, &error);
    database.error = error.text;
    return database;
}

inline std::string write_lensfun(const std::vector<lensprof_profile> &profiles, lensprof_status *status = nullptr,
                                 std::string *why = nullptr) {
    std::vector<const lensprof_profile *> pointers;
    for (const lensprof_profile &profile : profiles) pointers.push_back(&profile);
    const auto count = static_cast<uint32_t>(profiles.size());
    size_t needed = 0;
    lensprof_error error;
    lensprof_status result = lp_lensfun_write(pointers.data(), count, nullptr, nullptr, 0, &needed, &error);
    std::string text(needed, '\0');
    if (result == LENSPROF_OK)
        result = lp_lensfun_write(pointers.data(), count, nullptr, text.data(), needed, &needed, &error);
    if (status) *status = result;
    if (why) *why = error.text;
    return result == LENSPROF_OK ? text : "";
}

inline lensprof_profile lens_profile(const char *lens, double crop, double focal, double aperture, double distance,
                                     double k1, double k2 = 0, double k3 = 0) {
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    snprintf(profile.key.lens, sizeof profile.key.lens, "%s", lens);
    profile.key.crop_factor = crop, profile.key.focal_mm = focal, profile.key.aperture = aperture;
    profile.key.distance_m = distance;
    profile.vignetting[0] = {{k1, k2, k3}, {0, 0}};
    return profile;
}
