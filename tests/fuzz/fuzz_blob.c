/* Fuzzing profile blobs. Invariant for any bytes: they are refused and nothing is written, or they are a valid profile
 * that packs to the same bytes again, and plans from blob and profile give the same result. Everything is tried as it
 * is and with length and CRC corrected; otherwise mutations would not get past the CRC.
 *
 *   clang:  -fsanitize=fuzzer,address,undefined -DLENSPROF_LIBFUZZER, run with a copy of the folder corpus/blob
 *   others: fuzz_blob ROUNDS FILE...  mutates the files in the same way in every run */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lensprof/apply.h>
#include <lensprof/profile.h>

#include "core/blob.h"

enum {
    SIDE = 8,
    LARGEST = 1 << 16
};

static void demand(int holds, const char *what) {
    if (holds) return;
    fprintf(stderr, "fuzz_blob: %s\n", what);
    abort();
}

/* An 8 bit picture corrected with these options; 0 if no plan can be made. */
static int correct(const lensprof_apply_options *options, uint8_t *pixels) {
    const size_t bytes = lensprof_plan_bytes(options);
    if (!bytes) return 0;
    void *memory = malloc(bytes);
    const lensprof_plan *plan;
    const lensprof_status status = lensprof_plan_init(memory, bytes, options, &plan, NULL);
    if (status == LENSPROF_OK) {
        const lensprof_target image = {pixels, SIDE * 3, SIDE, SIDE, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
        demand(lensprof_apply(plan, NULL, &image, 0, 0) == LENSPROF_OK, "a plan was not applied");
    }
    free(memory);
    return status == LENSPROF_OK;
}

static void compare_plans(const uint8_t *blob, size_t bytes, const lensprof_profile *profile) {
    uint8_t a[SIDE * SIDE * 3], b[SIDE * SIDE * 3];
    for (size_t i = 0; i < sizeof a; i++) a[i] = b[i] = (uint8_t)(i * 37);
    lensprof_apply_options options;
    lensprof_apply_options_init(&options);
    options.frame_width = options.frame_height = SIDE;
    options.blob = blob, options.blob_bytes = bytes;
    demand(correct(&options, a) == (profile != NULL), "plan and profile disagree on the validity of the blob");
    if (!profile) return;
    options.blob = NULL;
    options.responses = profile->responses, options.response = profile->response;
    options.vignettings = profile->vignettings, options.vignetting = profile->vignetting;
    options.grid = &profile->grid;
    demand(correct(&options, b), "no plan from an unpacked profile");
    demand(memcmp(a, b, sizeof a) == 0, "blob and profile correct differently");
}

static int is_untouched(const lensprof_profile *profile) {
    const uint8_t *bytes = (const uint8_t *)profile;
    return bytes[4] == 0xA5 && memcmp(bytes + 4, bytes + 5, sizeof *profile - 5) == 0;
}

/* Returns whether the bytes are a profile. */
static int try_blob(const uint8_t *blob, size_t bytes) {
    static lensprof_profile profile;
    memset(&profile, 0xA5, sizeof profile);
    profile.struct_size = sizeof profile;
    const lensprof_status status = lensprof_profile_unpack(blob, bytes, &profile);
    if (status != LENSPROF_OK) {
        demand(status == LENSPROF_ERROR_CORRUPT || status == LENSPROF_ERROR_LAYOUT, "unexpected status");
        demand(is_untouched(&profile), "written in spite of an error");
        compare_plans(blob, bytes, NULL);
        return 0;
    }
    demand(lensprof_profile_validate(&profile) == LENSPROF_OK, "not a valid profile");
    size_t again_bytes = 0;
    uint8_t *again = malloc(bytes);
    demand(lensprof_profile_pack(&profile, LENSPROF_PACK_COVARIANCE, again, bytes, &again_bytes) == LENSPROF_OK,
           "cannot be packed again");
    demand(again_bytes == bytes && memcmp(again, blob, bytes) == 0, "packs to something else");
    free(again);
    compare_plans(blob, bytes, &profile);
    return 1;
}

static void put_u32(uint8_t *at, uint32_t value) {
    for (int i = 0; i < 4; i++) at[i] = (uint8_t)(value >> 8 * i);
}

/* As it is, then sealed, in memory of exactly its size. Returns whether the sealed blob is a profile. */
static int try_both(const uint8_t *data, size_t bytes) {
    uint8_t *copy = malloc(bytes + 1), *blob = copy + 1;
    int is_profile = 0;
    memcpy(blob, data, bytes);
    try_blob(blob, bytes);
    if (bytes >= 16) {
        memcpy(blob, "LPRF", 4);
        put_u32(blob + 8, (uint32_t)bytes);
        put_u32(blob + bytes - 4, lp_crc32(blob, bytes - 4));
        is_profile = try_blob(blob, bytes);
    }
    free(copy);
    return is_profile;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    if (bytes <= LARGEST) try_both(data, bytes);
    return 0;
}

#ifndef LENSPROF_LIBFUZZER

static uint64_t random_bits(uint64_t *state) {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    return *state ^= *state << 17;
}

static size_t below(uint64_t *state, size_t count) { return (size_t)(random_bits(state) >> 11) % count; }

/* One to three changes, mostly near the head with its counts and numbers. Returns the new length. */
static size_t mutate(uint8_t *data, size_t bytes, uint64_t *random) {
    static const uint32_t words[] = {0,          1,          3,          0x7f,       0xff,       0xffff,
                                     0x7f800000, 0x7fc00000, 0x3f800000, 0x80000000, 0xbf800000, 0xffffffff};
    for (size_t changes = 1 + below(random, 3); changes; changes--) {
        const size_t reach = below(random, 4) ? (bytes < 200 ? bytes : 200) : bytes, at = below(random, reach),
                     other = below(random, reach), left = bytes - (at > other ? at : other),
                     run = left < 8 ? left : 1 + below(random, left < 64 ? left : 64);
        switch (below(random, 7)) {
        case 0: data[at] ^= (uint8_t)(1u << below(random, 8)); break;
        case 1: data[at] = (uint8_t)random_bits(random); break;
        case 2: data[at] = (uint8_t)below(random, 40); break;
        case 3:
            if (at + 4 <= bytes) put_u32(data + at, words[below(random, sizeof words / sizeof *words)]);
            break;
        case 4: memmove(data + at, data + other, run); break;
        case 5: /* bytes removed */
            if (bytes - run >= 16) memmove(data + at, data + at + run, bytes - at - run), bytes -= run;
            break;
        default: /* bytes inserted */
            if (bytes + run <= LARGEST) {
                memmove(data + at + run, data + at, bytes - at), bytes += run;
                for (size_t i = 0; i < run; i++) data[at + i] = below(random, 2) ? (uint8_t)random_bits(random) : 0;
            }
        }
    }
    return bytes;
}

static size_t read_file(const char *name, uint8_t *data) {
    FILE *file = fopen(name, "rb");
    demand(file != NULL, name);
    const size_t bytes = fread(data, 1, LARGEST, file);
    fclose(file);
    return bytes;
}

int main(int argc, char **argv) {
    static uint8_t file[LARGEST], data[LARGEST];
    const long rounds = argc > 2 ? strtol(argv[1], NULL, 10) : 0;
    uint64_t random = 88172645463325252u;
    long tried = 0, profiles = 0;
    demand(rounds > 0, "usage: fuzz_blob ROUNDS FILE...");
    for (int i = 2; i < argc; i++) {
        const size_t bytes = read_file(argv[i], file);
        demand(try_blob(file, bytes), argv[i]);
        for (long round = 0; round < rounds; round++, tried++) {
            memcpy(data, file, bytes);
            profiles += try_both(data, mutate(data, bytes, &random));
        }
    }
    printf("%ld mutated blobs, %ld of them profiles once sealed\n", tried, profiles);
    demand(profiles > tried / 50 && profiles < tried, "mutations do not get past the checks, or nothing is refused");
    return 0;
}

#endif
