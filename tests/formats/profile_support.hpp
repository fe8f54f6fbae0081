// Profiles that use every member, and functions to read and write them in tests.
#pragma once

extern "C" {
#include "support.h"
}

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "formats/each_format.h"

using Profile = std::unique_ptr<lensprof_profile>;

inline Profile new_profile() {
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    return profile;
}

inline Profile copy_of(const lensprof_profile &profile) { return std::make_unique<lensprof_profile>(profile); }

// Three curves of each kind, a grid, a covariance, and numbers without a short decimal form.
inline Profile full_profile() {
    Profile p = new_profile();
    uint64_t random = 7;
    snprintf(p->key.camera_maker, sizeof p->key.camera_maker, "Acme \"quoted\" \\");
    snprintf(p->key.camera_model, sizeof p->key.camera_model, "Modèle 1");
    snprintf(p->key.lens, sizeof p->key.lens, "50mm f/1.8");
    snprintf(p->key.unit, sizeof p->key.unit, "123/456");
    p->key.crop_factor = 1.0 / 3.0, p->key.focal_mm = 50, p->key.aperture = 1.1 * 3, p->key.distance_m = INFINITY;
    p->key.processing = LENSPROF_PROCESSING_CORRECTED;
    p->provenance = {
        "flat", "lensprof 9.9.9", "a source", 1700000000123456789, 4000000000u, 7, 0.1 + 0.2, 1.0 / 7, "a doubt", 12, 1,
        0,      0.1 / 3,          {}};
    p->key.color_temperature_k = 4321.5;
    strcpy(p->key.style, "PROVIA (Standard)");
    p->responses = p->vignettings = 3;
    const double emor[3] = {0.1 + 0.2, -1.0 / 7, 0.0};
    assert_ok(lensprof_response_set_emor(&p->response[0], emor, 3));
    assert_ok(lensprof_response_set_gamma(&p->response[1], 2.2 / 3 * 3.1));
    const double table[4] = {0, 0.5 / 3, 0.7, 1};
    assert_ok(lensprof_response_set_table(&p->response[2], table, 4));
    for (int c = 0; c < 3; c++)
        p->vignetting[c] = {{-0.6 * lp_random(&random), -0.0, 0.1 * lp_random(&random)}, {1.0 / 17, -1.0 / 19}};
    p->grid.columns = 3, p->grid.rows = 2, p->grid.channels = 3;
    for (int i = 0; i < 18; i++) p->grid.attenuation[i] = static_cast<float>(0.9 + 0.2 * lp_random(&random));
    p->image_circle = {{0.1 / 3, -1.0 / 7}, 0.1 + 0.6};
    p->covariance_size = 5;
    for (int i = 0; i < 5; i++)
        for (int j = 0; j <= i; j++) p->covariance[5 * i + j] = p->covariance[5 * j + i] = lp_random(&random) * 1e-7;
    assert_ok(lensprof_profile_validate(p.get()));
    return p;
}

struct Read {
    lensprof_status status;
    std::string error;
    std::vector<Profile> profiles;
};

inline lensprof_status keep_profile(void *user, const lensprof_import_entry *entry) {
    assert_int_equal(entry->usable, 1);
    assert_ok(lensprof_profile_validate(entry->profile));
    static_cast<std::vector<Profile> *>(user)->push_back(copy_of(*entry->profile));
    return LENSPROF_OK;
}

// In memory of exactly its size, so that the address sanitizer detects reads beyond the end.
inline std::vector<char> exact(const std::string &text) { return {text.begin(), text.end()}; }

inline Read read_json(const std::string &text, const char *source = "a.json") {
    Read read{};
    lensprof_error error;
    const std::vector<char> bytes = exact(text);
    read.status = lp_json_read(bytes.data(), bytes.size(), source, keep_profile, &read.profiles, &error);
    read.error = error.text;
    assert_true((read.status == LENSPROF_OK) == read.error.empty());
    return read;
}

// Asks `write(text, capacity, needed, error)` for the size, then for the text; on failure returns "" and the error's
// text.
using WriteText = std::function<lensprof_status(void *, size_t, size_t *, lensprof_error *)>;
inline std::string written(const WriteText &write, lensprof_status *status = nullptr, std::string *why = nullptr) {
    size_t needed = 0;
    lensprof_error error{};
    lensprof_status result = write(nullptr, 0, &needed, &error);
    std::string text(needed, '\0');
    if (result == LENSPROF_OK) result = write(text.data(), needed, &needed, &error);
    if (status)
        *status = result;
    else
        assert_ok(result);
    if (why) *why = error.text;
    return result == LENSPROF_OK ? text : "";
}

inline std::string write_json(const std::vector<const lensprof_profile *> &profiles) {
    return written([&](void *text, size_t capacity, size_t *needed, lensprof_error *error) {
        return lp_json_write(profiles.data(), static_cast<uint32_t>(profiles.size()), text, capacity, needed, error);
    });
}

// The text with the first occurrence of `from` replaced.
inline std::string with(std::string text, const std::string &from, const std::string &to) {
    const size_t at = text.find(from);
    assert_true(at != std::string::npos);
    return text.replace(at, from.size(), to);
}
