// Fuzzing tables of responses: pcalib.txt, CSV and pfstools' .m. Invariant for any bytes: an
// invalid text gives a status of formats.h and an error text, and the outputs are untouched; otherwise every response
// is valid, and reads back after writing.
#include <memory>

#include "formats/each_format.h"

#include "fuzz_main.hpp"

namespace {

const char *const kTarget = "fuzz_curves";
const std::vector<std::string> kWords = {",",        ";",
                                         " ",        "\t",
                                         "\n",       "\r\n",
                                         "[",        "]",
                                         "#",        "# name: IR\n",
                                         "%",        "//",
                                         "0",        "-0",
                                         "1",        "-1",
                                         "0.5",      "255",
                                         "1e308",    "-1e308",
                                         "1e-320",   "5e-324",
                                         "nan",      "inf",
                                         "r,g,b\n",  "blue,green,red\n",
                                         "0 0\n",    "1,1,1\n",
                                         "\xC3\xA9", "\xFF",
                                         ".",        "+"};

struct Responses {
    lensprof_response r[3];
};

void check_outcome(lensprof_status status, const lensprof_error &error) {
    demand(status == LENSPROF_OK || status == LENSPROF_ERROR_SYNTAX || status == LENSPROF_ERROR_RESPONSE,
           "unexpected status");
    demand((status == LENSPROF_OK) == !error.text[0], "status and error text contradict each other");
}

bool try_pcalib(const std::vector<char> &bytes) {
    auto responses = std::make_unique<Responses>();
    lensprof_response &response = responses->r[0];
    lensprof_error error;
    response.kind = 99;
    const lensprof_status status = lp_pcalib_read(bytes.data(), bytes.size(), &response, &error);
    check_outcome(status, error);
    demand(status == LENSPROF_OK || response.kind == 99, "failed call wrote an output");
    if (status != LENSPROF_OK) return false;
    demand(lensprof_response_validate(&response) == LENSPROF_OK, "an invalid response");
    const std::vector<char> text = written([&](void *to, size_t capacity, size_t *needed) {
        return lp_pcalib_write(&response, to, capacity, needed, nullptr);
    });
    demand(lp_pcalib_read(text.data(), text.size(), &responses->r[1], nullptr) == LENSPROF_OK, "does not read back");
    return true;
}

bool try_curves(const std::vector<char> &bytes, uint32_t curve) {
    auto responses = std::make_unique<Responses>(), again = std::make_unique<Responses>();
    uint32_t count = 99, same = 0;
    lensprof_error error;
    const lensprof_status status = lp_curves_read(bytes.data(), bytes.size(), curve, responses->r, &count, &error);
    check_outcome(status, error);
    demand((status == LENSPROF_OK) == (count != 99), "status and outputs contradict each other");
    if (status != LENSPROF_OK) return false;
    for (uint32_t c = 0; c < count; c++)
        demand(lensprof_response_validate(&responses->r[c]) == LENSPROF_OK, "an invalid response");
    const std::vector<char> text = written([&](void *to, size_t capacity, size_t *needed) {
        return lp_curves_write(responses->r, count, curve, 64, to, capacity, needed, nullptr);
    });
    // A response that is black except at its end has no irradiance that a table of logarithms can hold.
    const lensprof_status read = lp_curves_read(text.data(), text.size(), curve, again->r, &same, nullptr);
    demand(read == LENSPROF_OK ? same == count : read == LENSPROF_ERROR_RESPONSE, "does not read back");
    return true;
}

bool try_bytes(const std::vector<char> &bytes) {
    bool read = try_pcalib(bytes);
    for (uint32_t curve = 0; curve <= LENSPROF_CURVE_FORWARD; curve++) read |= try_curves(bytes, curve);
    return read;
}

}  // namespace
