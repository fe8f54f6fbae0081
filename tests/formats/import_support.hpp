// Collects the entries that readers deliver.
#pragma once

extern "C" {
#include "support.h"
}

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "formats/each_format.h"

// The results of a reader.
struct Imported {
    lensprof_status status;
    std::string error;
    std::vector<std::unique_ptr<lensprof_profile>> profiles;
    std::vector<uint32_t> usable;
};

inline lensprof_status keep_entry(void *user, const lensprof_import_entry *entry) {
    auto *imported = static_cast<Imported *>(user);
    assert_int_equal(lensprof_profile_validate(entry->profile) == LENSPROF_OK, entry->usable);
    imported->profiles.push_back(std::make_unique<lensprof_profile>(*entry->profile));
    imported->usable.push_back(entry->usable);
    return LENSPROF_OK;
}

inline lensprof_status refuse_entry(void *, const lensprof_import_entry *) { return LENSPROF_ERROR_CANCELLED; }

// Attenuation of a profile at a place in a frame.
inline double attenuation_at(const lensprof_profile &profile, uint32_t width, uint32_t height, double x, double y,
                             uint32_t channel = 0) {
    const lensprof_vignetting &v = profile.vignetting[profile.vignettings == 3 ? channel : 0];
    return lensprof_vignetting_eval(&v, lensprof_vignetting_r2(&v, width, height, x, y, nullptr), nullptr)
           * lensprof_gain_grid_eval(&profile.grid, width, height, x, y, channel);
}

inline std::unique_ptr<lensprof_profile> profile_of(double k1, double k2, double k3, double x = 0.0, double y = 0.0) {
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    profile->vignetting[0] = {{k1, k2, k3}, {x, y}};
    return profile;
}

// Largest |a / b - 1| of two profiles over a frame.
inline double largest_difference(const lensprof_profile &a, const lensprof_profile &b, uint32_t width, uint32_t height,
                                 uint32_t channels) {
    double worst = 0.0;
    for (uint32_t c = 0; c < channels; c++)
        for (int j = 0; j <= 40; j++)
            for (int i = 0; i <= 40; i++) {
                const double x = i * (width - 1.0) / 40, y = j * (height - 1.0) / 40;
                const double ratio =
                    attenuation_at(a, width, height, x, y, c) / attenuation_at(b, width, height, x, y, c);
                worst = std::max(worst, std::fabs(ratio - 1.0));
            }
    return worst;
}
