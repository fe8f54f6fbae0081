// Fuzzing profiles as JSON. Invariant for any bytes: an invalid text gives a status of formats.h and an error text, and
// delivers no entry; otherwise every entry is a valid profile, and reads back the same after writing.
#include <memory>

#include "formats/each_format.h"

#include "fuzz_main.hpp"

namespace {

const char *const kTarget = "fuzz_json";
const std::vector<std::string> kWords = {"{",
                                         "}",
                                         "[",
                                         "]",
                                         ",",
                                         ":",
                                         "\"",
                                         "null",
                                         "true",
                                         "-",
                                         "0",
                                         "1",
                                         "-1",
                                         "0.5",
                                         "1e308",
                                         "1e-320",
                                         "1e999",
                                         "NaN",
                                         "[]",
                                         "{}",
                                         "\"infinity\"",
                                         "\"kind\":\"gamma\",\"gamma\":2.2",
                                         "\"gain_grid\":null,",
                                         "\"key\"",
                                         "\"profiles\":[",
                                         "\\u0000",
                                         "\\ud800",
                                         "\\\"",
                                         "\n",
                                         "4294967296",
                                         "9223372036854775808",
                                         "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
                                         "\xC3\xA9",
                                         "\xFF"};

using Profiles = std::vector<std::unique_ptr<lensprof_profile>>;

lensprof_status visit(void *user, const lensprof_import_entry *entry) {
    demand(entry->usable == 1 && lensprof_profile_validate(entry->profile) == LENSPROF_OK,
           "an entry that is not valid");
    static_cast<Profiles *>(user)->push_back(std::make_unique<lensprof_profile>(*entry->profile));
    return LENSPROF_OK;
}

lensprof_status read(const std::vector<char> &text, Profiles &profiles) {
    lensprof_error error;
    const lensprof_status status = lp_json_read(text.data(), text.size(), "fuzz", visit, &profiles, &error);
    demand(status == LENSPROF_OK || status == LENSPROF_ERROR_SYNTAX || status == LENSPROF_ERROR_UNSUPPORTED
               || status == LENSPROF_ERROR_VIGNETTING || status == LENSPROF_ERROR_RESPONSE
               || status == LENSPROF_ERROR_ARGUMENT || status == LENSPROF_ERROR_NOT_FINITE,
           "unexpected status");
    demand((status == LENSPROF_OK) == !error.text[0], "status and error text contradict each other");
    demand(status == LENSPROF_OK || profiles.empty(), "entries delivered despite an error");
    return status;
}

std::vector<char> write(const Profiles &profiles) {
    std::vector<const lensprof_profile *> pointers;
    for (const auto &profile : profiles) pointers.push_back(profile.get());
    const auto count = static_cast<uint32_t>(pointers.size());
    size_t bytes = 0;
    demand(lp_json_write(pointers.data(), count, nullptr, 0, &bytes, nullptr) == LENSPROF_OK, "not written");
    std::vector<char> text(bytes);
    demand(lp_json_write(pointers.data(), count, text.data(), bytes, &bytes, nullptr) == LENSPROF_OK, "not written");
    return text;
}

bool try_bytes(const std::vector<char> &bytes) {
    Profiles profiles, again;
    if (read(bytes, profiles) != LENSPROF_OK) return false;
    demand(read(write(profiles), again) == LENSPROF_OK && again.size() == profiles.size(), "does not read back");
    for (size_t i = 0; i < profiles.size(); i++)
        demand(std::memcmp(profiles[i].get(), again[i].get(), sizeof(lensprof_profile)) == 0,
               "reads back as another profile");
    return true;
}

}  // namespace
