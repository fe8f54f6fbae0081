// Fuzzing Lensfun databases. Invariant for any bytes: an invalid text gives a status of formats.h and an error text,
// and delivers no entry; otherwise every entry is a valid profile or marked unusable with the reason, and writable ones
// read back the same.
#include <cstring>

#include "fuzz_import.hpp"

#include "formats/each_format.h"

namespace {

const char *const kTarget = "fuzz_lensfun";

lensprof_status read(const std::vector<char> &text, Visited &visited) {
    lensprof_error error{};
    const lensprof_status status = lp_lensfun_read(text.data(), text.size(), "fuzz", visit, &visited, &error);
    check_reading(status, error, visited, {LENSPROF_ERROR_SYNTAX, LENSPROF_ERROR_UNSUPPORTED});
    return status;
}

// One profile at a time, because several may have the same setting.
void write_and_read(const lensprof_profile &profile) {
    const lensprof_profile *const pointer = &profile;
    size_t bytes = 0;
    demand(lp_lensfun_write(&pointer, 1, nullptr, 0, &bytes, nullptr) == LENSPROF_OK, "not written");
    std::vector<char> text(bytes);
    demand(lp_lensfun_write(&pointer, 1, text.data(), bytes, &bytes, nullptr) == LENSPROF_OK, "not written");
    Visited again;
    demand(read(text, again) == LENSPROF_OK && again.entries == 1, "does not read back");
    demand(again.usable.size() == 1 || profile.vignetting[0].center[0] || profile.vignetting[0].center[1],
           "a valid falloff is not one when read again");
    if (again.usable.empty()) return;  // rounding moved the centre beyond the minimum of M
    const lensprof_profile &other = *again.usable[0];
    for (int n = 0; n < 3; n++) demand(profile.vignetting[0].k[n] == other.vignetting[0].k[n], "k differs");
    demand(std::strcmp(profile.key.lens, other.key.lens) == 0, "lens differs");
    demand(profile.key.focal_mm == other.key.focal_mm && profile.key.aperture == other.key.aperture
               && profile.key.distance_m == other.key.distance_m && profile.key.crop_factor == other.key.crop_factor,
           "another setting");
}

bool try_bytes(const std::vector<char> &text) {
    Visited visited;
    const lensprof_status status = read(text, visited);
    for (const auto &profile : visited.usable) write_and_read(*profile);
    return status == LENSPROF_OK;
}

const std::vector<std::string> kWords = [] {
    std::vector<std::string> words = kXmlWords;
    for (const char *word : {"</lens>", "<lens>", "<calibration>", "</calibration>", "0.3", "-0.3", "1000", "k1=\"-2\"",
                             " lang=\"en\"", "<center x=\"1\" y=\"1\"/>", "acm"})
        words.push_back(word);
    return words;
}();

}  // namespace
