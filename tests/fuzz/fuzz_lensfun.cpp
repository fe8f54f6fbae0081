// Fuzzing Lensfun databases. Invariant for any bytes: an invalid text gives a status of formats.h and an error text,
// and delivers no entry; otherwise every entry is a valid profile or marked unusable with the reason, and writable ones
// read back the same within the digits that the format has.
#include <cmath>
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
    demand(lp_lensfun_write(&pointer, 1, nullptr, nullptr, 0, &bytes, nullptr) == LENSPROF_OK, "not written");
    std::vector<char> text(bytes);
    demand(lp_lensfun_write(&pointer, 1, nullptr, text.data(), bytes, &bytes, nullptr) == LENSPROF_OK, "not written");
    Visited again;
    const double own = profile.key.distance_m;
    const bool is_far = own == LENSPROF_UNKNOWN || std::isinf(own);
    const size_t entries = is_far || own == 10.0 ? 2 : own > 10.0 ? 3 : 1;  // its own, and those for infinity
    demand(read(text, again) == LENSPROF_OK && again.entries == entries, "does not read back");
    if (again.usable.empty()) return;                      // rounding of k moved the minimum of M below 0
    const lensprof_profile &other = *again.usable.back();  // of several, the one at infinity
    const bool is_kept = !profile.vignetting[0].center[0] && !profile.vignetting[0].center[1];  // else fitted again
    for (int n = 0; n < 3 && is_kept; n++)
        demand(std::fabs(profile.vignetting[0].k[n] - other.vignetting[0].k[n]) < 6e-5, "k differs");
    demand(profile.key.focal_mm == other.key.focal_mm && profile.key.aperture == other.key.aperture, "another setting");
    demand(std::fabs(profile.key.crop_factor - other.key.crop_factor) < 6e-4, "another crop factor");
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
