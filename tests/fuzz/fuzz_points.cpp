// Fuzzing point files of vig_optimize. What must hold for any bytes: a file with an error has one of the statuses of
// formats.h and a text that says why; of others as many pairs are read as are counted, and every one is within bounds.
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
           "another status");
    demand((status == LENSPROF_OK) == !error.text[0], "an error without a text, or the other way round");
    return status;
}

bool try_bytes(const std::vector<char> &bytes) {
    std::vector<lensprof_pair> pairs;
    uint32_t count = 0, again = 0;
    if (read(bytes, pairs, &count) != LENSPROF_OK || count == 0) return false;
    pairs.resize(count);
    if (read(bytes, pairs, &again) != LENSPROF_OK) return false;
    demand(again == count, "another number of pairs");
    for (const lensprof_pair &pair : pairs)
        for (int c = 0; c < 3; c++)
            for (int side = 0; side < 2; side++)
                demand(pair.value[side][c] >= 0.0 && pair.value[side][c] <= 1.0, "a grey value beyond 0..1");
    return true;
}

}  // namespace
