/* The store with many profiles: how long it takes to put them, to look one up and to predict one.
 *
 *   store FILE [PROFILES] [FOCALS]     FILE is made anew; FOCALS x 5 profiles a lens. Prints a table in Markdown. */
#include <lensprof/lensprof.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define APERTURES 5
#define LOOKUPS 4000

static lensprof_profile profile;
static lensprof_error error;

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void must(lensprof_status status) {
    if (status == LENSPROF_OK) return;
    fprintf(stderr, "store: %s %s\n", lensprof_status_name(status), error.text);
    exit(1);
}

static void make_key(lensprof_profile_key *key, int number, int focals) {
    const int lens = number / (focals * APERTURES), focal = number / APERTURES % focals;
    lensprof_profile_key_init(key);
    snprintf(key->camera_maker, sizeof key->camera_maker, "Maker %d", lens % 20);
    snprintf(key->camera_model, sizeof key->camera_model, "Camera %d", lens % 200);
    snprintf(key->lens, sizeof key->lens, "Maker %d 24-%dmm f/2.8 number %d", lens % 20, 70 + lens % 131, lens);
    key->focal_mm = 24.0 + 5.0 * focal;
    key->aperture = 2.8 * pow(2.0, number % APERTURES / 2.0);
    key->distance_m = INFINITY;
    key->crop_factor = 1.0;
    key->processing = LENSPROF_PROCESSING_RAW;
}

/* Every tenth with a covariance, all with a response of three modes. */
static void put_all(lensprof_store *store, int profiles, int focals) {
    static const double modes[3] = {0.1, 0.05, 0.01};
    must(lensprof_store_begin(store, &error));
    for (int i = 0; i < profiles; i++) {
        lensprof_profile_init(&profile);
        make_key(&profile.key, i, focals);
        snprintf(profile.provenance.method, sizeof profile.provenance.method, "transfer");
        must(lensprof_response_set_emor(&profile.response[0], modes, 3));
        profile.vignetting[0].k[0] = -1.0 / profile.key.aperture;
        if (i % 10 == 0) profile.covariance_size = 8;
        for (int d = 0; d < 8 && i % 10 == 0; d++) profile.covariance[9 * d] = 1e-5;
        must(lensprof_store_put(store, &profile, NULL, &error));
    }
    must(lensprof_store_commit(store, &error));
}

static int is_less(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* Median seconds of lookups of random profiles, `off` mm beside their focal lengths. */
static double lookup_median(lensprof_store *store, int profiles, int focals, double off) {
    static double seconds[LOOKUPS];
    uint32_t random = 1;
    lensprof_lookup how = {.struct_size = sizeof how};
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    for (int i = 0; i < LOOKUPS; i++) {
        lensprof_profile_key key;
        random = random * 1664525u + 1013904223u;
        make_key(&key, (int)((random >> 4) % (uint32_t)profiles), focals);
        key.focal_mm += off;
        const double start = now();
        must(lensprof_store_lookup(store, &key, &options, &profile, &how, &error));
        seconds[i] = now() - start;
        if (how.exact != (off == 0.0)) exit(2);
    }
    qsort(seconds, LOOKUPS, sizeof *seconds, is_less);
    return seconds[LOOKUPS / 2];
}

int main(int count, char **words) {
    if (count < 2) return 2;
    const int profiles = count > 2 ? atoi(words[2]) : 100000, focals = count > 3 ? atoi(words[3]) : 5;
    lensprof_store *store = NULL;
    remove(words[1]);
    must(lensprof_store_open(words[1], LENSPROF_STORE_CREATE, &store, &error));
    const double start = now();
    put_all(store, profiles, focals);
    const double put = now() - start;
    lensprof_store_close(store);
    must(lensprof_store_open(words[1], LENSPROF_STORE_READ, &store, &error));
    uint32_t faults;
    const double exact = lookup_median(store, profiles, focals, 0.0),
                 predicted = lookup_median(store, profiles, focals, 2.0);
    const double before = now();
    must(lensprof_store_check(store, NULL, NULL, NULL, &faults, &error));
    const double check = now() - before;
    lensprof_store_close(store);
    printf("| profiles | a lens | put, s | lookup, ms | predicted, ms | check, s |\n|---|---|---|---|---|---|\n");
    printf("| %d | %d | %.2f | %.3f | %.3f | %.2f |\n", profiles, focals * APERTURES, put, 1e3 * exact, 1e3 * predicted,
           check);
    return faults ? 1 : 0;
}
