// Fuzzing radical's files and Raspberry Pi tuning files. Invariant for any bytes: an invalid file gives a status of
// formats.h and an error text, and the outputs are untouched; otherwise the result is valid and reads back after
// writing.
#include <memory>

#include "formats/each_format.h"

#include "fuzz_main.hpp"

namespace {

const char *const kTarget = "fuzz_maps";
const std::vector<std::string> kWords = {std::string(4, '\0'),
                                         std::string("\x01\0\0\0", 4),
                                         std::string("\x05\0\0\0", 4),
                                         std::string("\0\x01\0\0", 4),
                                         "\xFF\xFF\xFF\xFF",
                                         std::string("\0\0\xC0\x7F", 4),
                                         std::string("\0\0\x80\x7F", 4),
                                         std::string("\0\0\x80\xBF", 4),
                                         std::string("\0\0\0\0\0\0\xF0\x7F", 8),
                                         std::string("\0\0\0\0\0\0\xF0\xBF", 8),
                                         "PolynomialVignettingModel 3 9 9\n",
                                         "NonparametricVignettingModel\n",
                                         "\n",
                                         " ",
                                         "0",
                                         "9",
                                         "-1",
                                         "1.5",
                                         "1e9",
                                         "null",
                                         "[",
                                         "]",
                                         "{",
                                         "}",
                                         ",",
                                         "\"ct\":4000",
                                         "\"default_ct\":1,",
                                         "\"corner_strength\":2,",
                                         "\"rpi.alsc\"",
                                         "\xD9\xFD\xA1\xC4"};

using Profile = std::unique_ptr<lensprof_profile>;

Profile new_profile() {
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    return profile;
}

void check_outcome(lensprof_status status, const lensprof_error &error) {
    demand(status == LENSPROF_OK || status == LENSPROF_ERROR_SYNTAX || status == LENSPROF_ERROR_UNSUPPORTED
               || status == LENSPROF_ERROR_SIZE || status == LENSPROF_ERROR_RESPONSE
               || status == LENSPROF_ERROR_VIGNETTING || status == LENSPROF_ERROR_NOT_FINITE
               || status == LENSPROF_ERROR_ARGUMENT || status == LENSPROF_ERROR_NOT_FOUND,
           "unexpected status");
    demand((status == LENSPROF_OK) == !error.text[0], "status and error text contradict each other");
}

// Whether a falloff was read. If so, it is valid and its error known; otherwise the profile is untouched.
bool check_falloff(lensprof_status status, const lensprof_error &error, const lensprof_profile &profile, double worst) {
    check_outcome(status, error);
    if (status != LENSPROF_OK) {
        demand(std::memcmp(&profile, new_profile().get(), sizeof profile) == 0 && worst == -7.0,
               "failed call wrote an output");
        return false;
    }
    demand(lensprof_profile_validate(&profile) == LENSPROF_OK, "an invalid profile");
    demand(worst >= 0.0, "refit error is missing");
    return true;
}

bool try_responses(const std::vector<char> &bytes) {
    auto responses = std::make_unique<lensprof_response[]>(6);
    lensprof_error error;
    const lensprof_status status = lp_radical_response_read(bytes.data(), bytes.size(), responses.get(), &error);
    check_outcome(status, error);
    if (status != LENSPROF_OK) return false;
    for (int c = 0; c < 3; c++) demand(lensprof_response_validate(&responses[c]) == LENSPROF_OK, "an invalid response");
    const std::vector<char> data = written([&](void *to, size_t capacity, size_t *needed) {
        return lp_radical_response_write(responses.get(), 3, to, capacity, needed, nullptr);
    });
    demand(lp_radical_response_read(data.data(), data.size(), responses.get() + 3, nullptr) == LENSPROF_OK,
           "does not read back");
    return true;
}

bool try_vignetting(const std::vector<char> &bytes) {
    const Profile profile = new_profile(), again = new_profile();
    lensprof_error error;
    double worst = -7.0;
    const lensprof_status status =
        lp_radical_vignetting_read(bytes.data(), bytes.size(), profile.get(), &worst, &error);
    if (!check_falloff(status, error, *profile, worst)) return false;
    const std::vector<char> data = written([&](void *to, size_t capacity, size_t *needed) {
        return lp_radical_vignetting_write(profile.get(), 16, 12, to, capacity, needed, nullptr);
    });
    const lensprof_status read = lp_radical_vignetting_read(data.data(), data.size(), again.get(), nullptr, nullptr);
    // A falloff at the limit of validity may exceed it when rounded or refitted.
    demand(read == LENSPROF_OK || read == LENSPROF_ERROR_VIGNETTING, "does not read back");
    return true;
}

bool try_tables(const std::vector<char> &bytes) {
    const Profile profile = new_profile();
    lensprof_error error;
    double worst = -7.0;
    const lensprof_status status =
        lp_alsc_read(bytes.data(), bytes.size(), 4000, 4, 3, 400, 300, profile.get(), &worst, &error);
    if (!check_falloff(status, error, *profile, worst)) return false;
    written([&](void *to, size_t capacity, size_t *needed) {
        return lp_alsc_write(profile.get(), 4000, 4, 3, 400, 300, to, capacity, needed, nullptr);
    });
    return true;
}

bool try_bytes(const std::vector<char> &bytes) {
    const bool responses = try_responses(bytes), vignetting = try_vignetting(bytes);
    return try_tables(bytes) || responses || vignetting;
}

}  // namespace
