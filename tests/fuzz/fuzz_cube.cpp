// Fuzzing one-dimensional cubes. Invariant for any bytes: an invalid text gives a status of formats.h and an error
// text, and the outputs are untouched; otherwise every response is valid, and reads back after writing.
#include <algorithm>
#include <memory>

#include "formats/each_format.h"

#include "fuzz_main.hpp"

namespace {

const char *const kTarget = "fuzz_cube";
const std::vector<std::string> kWords = {"LUT_1D_SIZE ",
                                         "LUT_3D_SIZE ",
                                         "LUT_1D_INPUT_RANGE ",
                                         "DOMAIN_MIN 0 0 0\n",
                                         "DOMAIN_MAX 1 1 1\n",
                                         "TITLE \"",
                                         "#",
                                         " ",
                                         "\t",
                                         "\n",
                                         "\r\n",
                                         "0 0 0\n",
                                         "1 1 1\n",
                                         "-0",
                                         "-1",
                                         "65536",
                                         "65537",
                                         "1e308",
                                         "-1e308",
                                         "5e-324",
                                         "nan",
                                         "inf",
                                         "\xEF\xBB\xBF",
                                         "\xFF"};

// The outputs of a failed call keep this.
constexpr uint32_t kUntouched = 99;

void check_outcome(lensprof_status status, const lensprof_error &error, uint32_t count) {
    demand(status == LENSPROF_OK || status == LENSPROF_ERROR_SYNTAX || status == LENSPROF_ERROR_RESPONSE
               || status == LENSPROF_ERROR_SIZE || status == LENSPROF_ERROR_UNSUPPORTED,
           "unexpected status");
    demand((status == LENSPROF_OK) == !error.text[0], "status and error text contradict each other");
    demand((status == LENSPROF_OK) == (count != kUntouched), "status and outputs contradict each other");
}

bool try_curve(const std::vector<char> &bytes, uint32_t curve) {
    auto profile = std::make_unique<lensprof_profile>(), again = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    uint32_t count = kUntouched, same = 0;
    lensprof_error error;
    const lensprof_status status = lp_cube_read(bytes.data(), bytes.size(), curve, profile->response, &count, &error);
    check_outcome(status, error, count);
    if (count == kUntouched) return false;
    for (uint32_t c = 0; c < count; c++)
        demand(lensprof_response_validate(&profile->response[c]) == LENSPROF_OK, "an invalid response");
    profile->responses = count;
    const std::vector<char> text = written([&](void *to, size_t capacity, size_t *needed) {
        return lp_cube_write(profile.get(), curve, 64, to, capacity, needed, nullptr);
    });
    demand(lp_cube_read(text.data(), text.size(), curve, again->response, &same, nullptr) == LENSPROF_OK,
           "does not read back");
    demand(same == count || same == 1, "another number of responses");  // which may be equal at the rows
    return true;
}

bool try_bytes(const std::vector<char> &bytes) {
    const bool inverse = try_curve(bytes, LENSPROF_CURVE_INVERSE), forward = try_curve(bytes, LENSPROF_CURVE_FORWARD);
    return inverse || forward;
}

}  // namespace
