// The frame of a fuzz target for text or binary files: the entry point of libFuzzer, or a program that mutates a
// corpus.
//
//   clang:  -fsanitize=fuzzer,address,undefined -DLENSPROF_LIBFUZZER, run with a copy of the target's corpus folder
//   others: TARGET ROUNDS FILE...  mutates the files in the same way in every run
//
// Included by a single file, which defines the three declarations below.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <lensprof/base.h>

namespace {

extern const char *const kTarget;
extern const std::vector<std::string> kWords;  // words that are difficult for parsers

// Checks the invariant for any bytes; true if they were read.
bool try_bytes(const std::vector<char> &bytes);

constexpr size_t kLargest = 1 << 14;

void demand(bool holds, const char *what) {
    if (holds) return;
    std::fprintf(stderr, "%s: %s\n", kTarget, what);
    std::abort();
}

// The output of a writer, which is first asked for the size.
template <typename Write>
[[maybe_unused]] std::vector<char> written(Write write) {
    size_t bytes = 0;
    demand(write(nullptr, 0, &bytes) == LENSPROF_OK, "not written");
    std::vector<char> data(bytes);
    demand(write(data.data(), bytes, &bytes) == LENSPROF_OK, "not written");
    return data;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    if (bytes <= kLargest) try_bytes(std::vector<char>(data, data + bytes));
    return 0;
}

#ifndef LENSPROF_LIBFUZZER
namespace {

uint64_t random_bits(uint64_t &state) {
    state ^= state << 13;
    state ^= state >> 7;
    return state ^= state << 17;
}

size_t below(uint64_t &state, size_t count) { return static_cast<size_t>(random_bits(state) >> 11) % count; }

// One to three changes: a byte; a piece removed, moved or repeated; a digit; or one of the words.
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
        case 4: text.replace(at, below(random, 4), kWords[below(random, kWords.size())]); break;
        default: text.insert(at, kWords[below(random, kWords.size())]);
        }
    }
    return text.substr(0, kLargest);
}

}  // namespace

int main(int argc, char **argv) {
    const long rounds = argc > 2 ? std::strtol(argv[1], nullptr, 10) : 0;
    uint64_t random = 88172645463325252u;
    long tried = 0, good = 0;
    demand(rounds > 0, "usage: ROUNDS FILE...");
    for (int i = 2; i < argc; i++) {
        std::ifstream file(argv[i], std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        demand(try_bytes(std::vector<char>(text.begin(), text.end())), argv[i]);
        for (long round = 0; round < rounds; round++, tried++) {
            const std::string mutated = mutate(text, random);
            good += try_bytes(std::vector<char>(mutated.begin(), mutated.end()));
        }
    }
    std::printf("%ld mutated files, %ld of them read\n", tried, good);
    demand(good > tried / 50 && good < tried, "mutations do not get past the parser, or nothing is refused");
    return 0;
}
#endif
