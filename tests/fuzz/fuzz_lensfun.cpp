// Fuzzing Lensfun databases. What must hold for any bytes: a text with an error has one of the statuses of formats.h, a
// text that says why, and nothing of it is visited; of others every entry is a valid profile or marked, with the reason,
// and what can be written reads back the same.
//
//   clang:  -fsanitize=fuzzer,address,undefined -DLENSPROF_LIBFUZZER, run with a copy of the folder corpus/lensfun
//   others: fuzz_lensfun ROUNDS FILE...  mutates the files, the same way in every run
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <lensprof/formats.h>

namespace {

using Profiles = std::vector<std::unique_ptr<lensprof_profile>>;

constexpr size_t kLargest = 1 << 14;

void demand(bool holds, const char *what) {
    if (holds) return;
    std::fprintf(stderr, "fuzz_lensfun: %s\n", what);
    std::abort();
}

struct Visited {
    Profiles usable;
    size_t entries = 0;
};

lensprof_status visit(void *user, const lensprof_import_entry *entry) {
    auto *visited = static_cast<Visited *>(user);
    const lensprof_profile &profile = *entry->profile;
    const bool valid = lensprof_profile_validate(&profile) == LENSPROF_OK;
    demand(valid == (entry->usable == 1), "usable and not valid, or the other way round");
    demand(valid || profile.provenance.doubt[0], "not usable without a reason");
    demand(lensprof_profile_key_validate(&profile.key) == LENSPROF_OK, "a key that is not valid");
    visited->entries++;
    if (valid) visited->usable.push_back(std::make_unique<lensprof_profile>(profile));
    return LENSPROF_OK;
}

lensprof_status read(const std::vector<char> &text, Visited &visited) {
    lensprof_error error;
    const lensprof_status status = lensprof_lensfun_read(text.data(), text.size(), "fuzz", visit, &visited, &error);
    demand(status == LENSPROF_OK || status == LENSPROF_ERROR_SYNTAX || status == LENSPROF_ERROR_UNSUPPORTED,
           "another status");
    demand((status == LENSPROF_OK) == !error.text[0], "an error without a text, or the other way round");
    demand(status == LENSPROF_OK || visited.entries == 0, "entries of a text with an error");
    return status;
}

// One profile at a time, as several may be of the same setting.
void write_and_read(const lensprof_profile &profile) {
    const lensprof_profile *const pointer = &profile;
    size_t bytes = 0;
    demand(lensprof_lensfun_write(&pointer, 1, nullptr, 0, &bytes, nullptr) == LENSPROF_ERROR_CAPACITY, "not written");
    std::vector<char> text(bytes);
    demand(lensprof_lensfun_write(&pointer, 1, text.data(), bytes, &bytes, nullptr) == LENSPROF_OK, "not written");
    Visited again;
    demand(read(text, again) == LENSPROF_OK && again.entries == 1, "not read again");
    demand(again.usable.size() == 1 || profile.vignetting[0].center[0] || profile.vignetting[0].center[1],
           "a valid falloff is not one when read again");
    if (again.usable.empty()) return;  // a centre rounded beyond where M reaches its least value
    const lensprof_profile &other = *again.usable[0];
    for (int n = 0; n < 3; n++) demand(profile.vignetting[0].k[n] == other.vignetting[0].k[n], "another k");
    demand(std::strcmp(profile.key.lens, other.key.lens) == 0, "another lens");
    demand(profile.key.focal_mm == other.key.focal_mm && profile.key.aperture == other.key.aperture
               && profile.key.distance_m == other.key.distance_m && profile.key.crop_factor == other.key.crop_factor,
           "another setting");
}

bool try_text(const std::vector<char> &text) {
    Visited visited;
    const lensprof_status status = read(text, visited);
    for (const auto &profile : visited.usable) write_and_read(*profile);
    return status == LENSPROF_OK;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    if (bytes <= kLargest) try_text(std::vector<char>(data, data + bytes));
    return 0;
}

#ifndef LENSPROF_LIBFUZZER
namespace {

const char *const kWords[] = {
    "<", ">", "/>", "</lens>", "<lens>", "<calibration>", "</calibration>", "<!--", "-->", "<![CDATA[", "]]>", "\"", "'", "=",
    "&", "&amp;", "&#0;", "&#x10FFFF;", "&#xD800;", "<?", "<!DOCTYPE a [", "\n", "0", "-1", "1e308", "1e-308", "nan", "inf",
    "0.3", "-0.3", "1000", ":", ",", "k1=\"-2\"", " lang=\"en\"", "<center x=\"1\" y=\"1\"/>", "acm", "\xC3\xA9", "\xFF"};

uint64_t random_bits(uint64_t &state) {
    state ^= state << 13;
    state ^= state >> 7;
    return state ^= state << 17;
}

size_t below(uint64_t &state, size_t count) {
    return static_cast<size_t>(random_bits(state) >> 11) % count;
}

// One to three changes: a byte, a piece taken out, moved or doubled, a digit, or a word that parsers stumble over.
std::string mutate(std::string text, uint64_t &random) {
    for (size_t changes = 1 + below(random, 3); changes && !text.empty(); changes--) {
        const size_t at = below(random, text.size()), from = below(random, text.size()), run = 1 + below(random, 60);
        switch (below(random, 6)) {
        case 0: text[at] = static_cast<char>(random_bits(random)); break;
        case 1: text.erase(at, run); break;
        case 2: text.insert(at, text.substr(from, run)); break;
        case 3: {
            const size_t digit = text.find_first_of("0123456789", at);
            if (digit != std::string::npos) text[digit] = static_cast<char>('0' + below(random, 10));
            break;
        }
        case 4: text.replace(at, below(random, 4), kWords[below(random, std::size(kWords))]); break;
        default: text.insert(at, kWords[below(random, std::size(kWords))]);
        }
    }
    return text.substr(0, kLargest);
}

}  // namespace

int main(int argc, char **argv) {
    const long rounds = argc > 2 ? std::strtol(argv[1], nullptr, 10) : 0;
    uint64_t random = 88172645463325252u;
    long tried = 0, good = 0;
    demand(rounds > 0, "usage: fuzz_lensfun ROUNDS FILE...");
    for (int i = 2; i < argc; i++) {
        std::ifstream file(argv[i], std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        demand(try_text(std::vector<char>(text.begin(), text.end())), argv[i]);
        for (long round = 0; round < rounds; round++, tried++) {
            const std::string mutated = mutate(text, random);
            good += try_text(std::vector<char>(mutated.begin(), mutated.end()));
        }
    }
    std::printf("%ld mutated databases, %ld of them read\n", tried, good);
    demand(good > tried / 50 && good < tried, "mutations do not get past the parser, or nothing is refused");
    return 0;
}
#endif
