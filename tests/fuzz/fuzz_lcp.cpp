// Fuzzing Adobe lens profiles. Invariant for any bytes: an invalid text gives a status of formats.h and an error text,
// and delivers no entry; otherwise every entry is a valid profile or marked unusable with the reason, and writable ones
// read back the same.
#include <cmath>
#include <cstring>

#include "fuzz_import.hpp"

#include "formats/each_format.h"

namespace {

const char *const kTarget = "fuzz_lcp";

lensprof_status read(const std::vector<char> &text, Visited &visited) {
    lensprof_error error{};
    const lensprof_status status = lp_lcp_read(text.data(), text.size(), "fuzz", visit, &visited, &error);
    check_reading(status, error, visited, {LENSPROF_ERROR_SYNTAX});
    return status;
}

bool same(double a, double b) { return a == b || std::fabs(a - b) <= 1e-9 * std::fabs(a); }

void write_and_read(const lensprof_profile &profile) {
    const lensprof_profile *const pointer = &profile;
    size_t size = 0;
    const lensprof_status status = lp_lcp_write(&pointer, 1, 600, 400, nullptr, 0, &size, nullptr);
    demand(status == LENSPROF_OK || status == LENSPROF_ERROR_ARGUMENT || status == LENSPROF_ERROR_UNSUPPORTED,
           "another status of writing");
    if (status != LENSPROF_OK) return;
    std::vector<char> text(size);
    demand(lp_lcp_write(&pointer, 1, 600, 400, text.data(), size, &size, nullptr) == LENSPROF_OK, "not written");
    Visited again;
    const lensprof_status reread = read(text, again);
    if (reread != LENSPROF_OK || again.usable.empty()) return;  // numbers outside the range of a lens profile
    const lensprof_profile &other = *again.usable[0];
    demand(std::strcmp(profile.key.lens, other.key.lens) == 0, "lens differs");
    demand(same(profile.key.focal_mm, other.key.focal_mm) && same(profile.key.aperture, other.key.aperture)
               && same(profile.key.crop_factor, other.key.crop_factor),
           "another setting");
    for (int n = 0; n < 3; n++) demand(same(profile.vignetting[0].k[n], other.vignetting[0].k[n]), "k differs");
}

bool try_bytes(const std::vector<char> &text) {
    Visited visited;
    const lensprof_status status = read(text, visited);
    for (const auto &profile : visited.usable) write_and_read(*profile);
    return status == LENSPROF_OK;
}

const std::vector<std::string> kWords = [] {
    std::vector<std::string> words = kXmlWords;
    for (const char *word : {"</rdf:li>", "<rdf:li>", "<rdf:Description>", "</rdf:Description>", "-0.3", "1000", "True",
                             " stCamera:Lens=\"x\"", " stCamera:FocalLengthX=\"0.5\"", " stCamera:ImageWidth=\"1\"",
                             "<stCamera:VignetteModel>", "</stCamera:VignetteModel>"})
        words.push_back(word);
    return words;
}();

}  // namespace
