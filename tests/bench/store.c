/* The store with many profiles: time to put them, to look one up and to predict one. Lenses have raw profiles; half of
 * the cameras also have BRACKETS profiles of their JPEG, without a lens.
 *
 *   store FILE [PROFILES] [FOCALS]     FILE is created; FOCALS x 5 profiles per lens. Prints a Markdown table. */
#include <lensprof/lensprof.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define APERTURES 5
#define CAMERAS 200
#define BRACKETS 2
#define LOOKUPS 4000

/* Kinds of queries. */
typedef enum question {
    STORED,        /* raw, a stored setting */
    PREDICTED,     /* raw, 2 mm from a stored setting */
    JPEG_TYPICAL,  /* the same for a JPEG, from a camera without a response */
    JPEG_MEASURED, /* from a camera with BRACKETS responses */
    QUESTIONS
} question;

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
    snprintf(key->camera_model, sizeof key->camera_model, "Camera %d", lens % CAMERAS);
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
    for (int i = 0; i < BRACKETS * CAMERAS / 2; i++) {
        lensprof_profile_init(&profile);
        make_key(&profile.key, 0, focals);
        snprintf(profile.key.camera_model, sizeof profile.key.camera_model, "Camera %d", 2 * (i / BRACKETS));
        snprintf(profile.key.camera_maker, sizeof profile.key.camera_maker, "Maker %d", 2 * (i / BRACKETS) % 20);
        profile.key.lens[0] = 0;
        profile.key.focal_mm = profile.key.aperture = profile.key.distance_m = LENSPROF_UNKNOWN;
        profile.key.processing = LENSPROF_PROCESSING_JPEG;
        must(lensprof_response_set_emor(&profile.response[0], modes, 3));
        profile.covariance_size = 6;
        for (int d = 0; d < 3; d++) profile.covariance[7 * d] = 1e-5;
        must(lensprof_store_put(store, &profile, NULL, &error));
    }
    must(lensprof_store_commit(store, &error));
}

static int is_less(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* Whether the answer is of the queried kind. */
static int is_as_asked(const lensprof_lookup *how, question what) {
    static const uint32_t from[QUESTIONS] = {LENSPROF_RESPONSE_FROM_PROFILE, LENSPROF_RESPONSE_FROM_RAW,
                                             LENSPROF_RESPONSE_FROM_KIND, LENSPROF_RESPONSE_FROM_CAMERA};
    return how->exact == (what == STORED) && how->response_from == from[what];
}

/* Median seconds of lookups of random profiles. */
static double lookup_median(lensprof_store *store, int profiles, int focals, question what) {
    static double seconds[LOOKUPS];
    uint32_t random = 1;
    lensprof_lookup how = {.struct_size = sizeof how};
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    for (int i = 0; i < LOOKUPS; i++) {
        lensprof_profile_key key;
        int number, has_brackets;
        do {
            random = random * 1664525u + 1013904223u;
            number = (int)((random >> 4) % (uint32_t)profiles);
            has_brackets = number / (focals * APERTURES) % CAMERAS % 2 == 0;
        } while (what >= JPEG_TYPICAL && has_brackets != (what == JPEG_MEASURED));
        make_key(&key, number, focals);
        if (what != STORED) key.focal_mm += 2.0;
        if (what >= JPEG_TYPICAL) key.processing = LENSPROF_PROCESSING_JPEG;
        const double start = now();
        must(lensprof_store_lookup(store, &key, &options, &profile, &how, &error));
        seconds[i] = now() - start;
        if (!is_as_asked(&how, what)) exit(2);
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
    double median[QUESTIONS];
    for (int what = 0; what < QUESTIONS; what++) median[what] = lookup_median(store, profiles, focals, (question)what);
    const double before = now();
    must(lensprof_store_check(store, NULL, NULL, NULL, &faults, &error));
    const double check = now() - before;
    lensprof_store_close(store);
    printf(
        "| profiles | a lens | put, s | lookup, ms | predicted, ms | JPEG, typical response, ms | JPEG, the camera's, ms"
        " | check, s |\n|---|---|---|---|---|---|---|---|\n| %d | %d | %.2f |",
        profiles, focals * APERTURES, put);
    for (int what = 0; what < QUESTIONS; what++) printf(" %.3f |", 1e3 * median[what]);
    printf(" %.2f |\n", check);
    return faults ? 1 : 0;
}
