// Fuzzing point files of vig_optimize. Invariant for any bytes: an invalid file gives a status of formats.h and an
// error text; otherwise as many pairs are read as are counted, and all are within bounds.
#include <cmath>

#include <lensprof/formats.h>

#include "fuzz_main.hpp"

namespace {

const char *const kTarget = "fuzz_points";
const std::vector<std::string> kWords = {"\n",     "\r",   " ",           "\t",  "nan", "inf",  "-", "-1",  "1e309",
                                         "1e-400", "0.25", "99999999999", "1.5", "#",   "\xFF", ",", "0 1 "};

lensprof_status read(const std::vector<char> &text, std::vector<lensprof_pair> &pairs, uint32_t *count) {
    lensprof_error error{};
    const lensprof_status status = lensprof_points_read(text.data(), text.size(), pairs.data(),
                                                        static_cast<uint32_t>(pairs.size()), count, &error);
    demand(status == LENSPROF_OK || status == LENSPROF_ERROR_SYNTAX || status == LENSPROF_ERROR_SIZE
               || status == LENSPROF_ERROR_ARGUMENT,
           "unexpected status");
    demand((status == LENSPROF_OK) == !error.text[0], "status and error text contradict each other");
    return status;
}

bool try_bytes(const std::vector<char> &bytes) {
    std::vector<lensprof_pair> pairs;
    uint32_t count = 0, again = 0;
    if (read(bytes, pairs, &count) != LENSPROF_OK || count == 0) return false;
    pairs.resize(count);
    if (read(bytes, pairs, &again) != LENSPROF_OK) return false;
    demand(again == count, "number of pairs differs");
    for (const lensprof_pair &pair : pairs)
        for (int c = 0; c < 3; c++)
            for (int side = 0; side < 2; side++)
                demand(pair.value[side][c] >= 0.0 && pair.value[side][c] <= 1.0, "grey value outside 0..1");
    return true;
}

}  // namespace
