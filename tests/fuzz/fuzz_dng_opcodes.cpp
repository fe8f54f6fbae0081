// Fuzzing DNG opcode lists. Invariant for any bytes: an invalid list gives a status of formats.h and an error text, and
// delivers no entry; otherwise the falloff is a valid profile or marked unusable with the reason, and reads back after
// writing.
#include "fuzz_import.hpp"

#include "formats/each_format.h"

namespace {

const char *const kTarget = "fuzz_dng_opcodes";

constexpr uint32_t kWidth = 18, kHeight = 12;  // small, so that maps are sampled at few places

lensprof_status read(const std::vector<char> &bytes, uint32_t layout, Visited &visited) {
    lensprof_error error{};
    const lensprof_status status =
        lp_dng_opcodes_read(bytes.data(), bytes.size(), kWidth, kHeight, layout, "fuzz", visit, &visited, &error);
    check_reading(status, error, visited,
                  {LENSPROF_ERROR_SYNTAX, LENSPROF_ERROR_UNSUPPORTED, LENSPROF_ERROR_SIZE, LENSPROF_ERROR_NOT_FOUND,
                   LENSPROF_ERROR_NOT_FINITE, LENSPROF_ERROR_VIGNETTING});
    return status;
}

// Writes a falloff as a map; a steep one may be invalid after reading it back.
void write_and_read(const lensprof_profile &profile) {
    size_t size = 0;
    demand(lp_dng_opcodes_write(&profile, kWidth, kHeight, LENSPROF_LAYOUT_RGGB, LENSPROF_DNG_GAIN_MAP, nullptr, 0,
                                &size, nullptr, nullptr)
               == LENSPROF_OK,
           "not written");
    std::vector<char> bytes(size);
    demand(lp_dng_opcodes_write(&profile, kWidth, kHeight, LENSPROF_LAYOUT_RGGB, LENSPROF_DNG_GAIN_MAP, bytes.data(),
                                size, &size, nullptr, nullptr)
               == LENSPROF_OK,
           "not written");
    Visited again;
    const lensprof_status status = read(bytes, LENSPROF_LAYOUT_RGGB, again);
    demand(status == LENSPROF_OK || status == LENSPROF_ERROR_VIGNETTING, "does not read back");
}

bool try_bytes(const std::vector<char> &bytes) {
    Visited planes, mosaic;
    const lensprof_status status = read(bytes, LENSPROF_LAYOUT_RGB, planes);
    const lensprof_status other = read(bytes, LENSPROF_LAYOUT_GBRG, mosaic);
    for (const auto &profile : planes.usable) write_and_read(*profile);
    return status == LENSPROF_OK || other == LENSPROF_OK;
}

const std::vector<std::string> kWords = {std::string(4, '\0'),
                                         std::string("\0\0\0\x01", 4),
                                         "\xFF\xFF\xFF\xFF",
                                         "\x7F\xF0",
                                         "\x7F\xF8",
                                         "\x80",
                                         "\x3F\xE0",
                                         "\x3F\x80",
                                         "\x01\x03"};

}  // namespace
