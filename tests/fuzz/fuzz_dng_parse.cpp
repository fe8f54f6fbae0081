// Fuzzing the parser of DNG opcode lists alone, many more runs than in fuzz_dng_opcodes, which also samples, fits and
// writes every list. Invariant for any bytes: they are parsed or an error gives the reason, and the result stays within
// the limits that parse_opcodes() promises.
#include "formats/dng_opcodes.hpp"
#include "formats/text/text.hpp"
#include "fuzz_main.hpp"

namespace {

const char *const kTarget = "fuzz_dng_parse";

bool try_bytes(const std::vector<char> &bytes) {
    try {
        const auto gains = lensprof::parse_opcodes(reinterpret_cast<const uint8_t *>(bytes.data()), bytes.size());
        size_t points = 0;
        for (const auto &map : gains.maps) {
            demand(map.gains.size() == size_t{map.rows} * map.columns * map.map_planes, "map size differs");
            points += map.gains.size();
        }
        demand(gains.radial.size() + gains.maps.size() <= 64 && points <= 1 << 20, "beyond the limits");
        return true;
    } catch (const lensprof::FormatFailure &failure) {
        demand(!failure.text.empty(), "a failure without a text");
        return false;
    }
}

const std::vector<std::string> kWords = {
    std::string(4, '\0'), std::string("\0\0\0\x01", 4), "\xFF\xFF\xFF\xFF", "\x7F\xF0", "\x80", "\x3F\xE0", "\x01\x03"};

}  // namespace
