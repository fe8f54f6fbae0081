/* Common parts of the tests of lookups: a lens with a known falloff at all settings, and queries. */
#ifndef LENSPROF_TESTS_LOOKUP_FIXTURE_H
#define LENSPROF_TESTS_LOOKUP_FIXTURE_H

#include "store_fixture.h"

static lensprof_profile shared; /* 50 kB */

static inline lensprof_profile *zoom_profile(const char *lens, double focal, double aperture, double distance) {
    lensprof_profile *p = &shared;
    lensprof_profile_init(p);
    snprintf(p->key.lens, sizeof p->key.lens, "%s", lens);
    p->key.focal_mm = focal, p->key.aperture = aperture, p->key.distance_m = distance;
    p->key.processing = LENSPROF_PROCESSING_RAW;
    p->key.crop_factor = 1.0;
    return p;
}

/* The falloff of a lens, weaker when stopped down and at longer focal lengths. */
static inline void true_falloff(double focal, double aperture, double k[3]) {
    const double open = 1.8 / aperture;
    k[0] = -0.12 - 0.45 * open * open - 0.1 * log2(70.0 / focal) * open;
    k[1] = 0.15 * open;
    k[2] = -0.06 * open * open;
}

static inline int64_t put_falloff(lensprof_store *store, const char *lens, double focal, double aperture,
                                  double distance) {
    lensprof_profile *p = zoom_profile(lens, focal, aperture, distance);
    true_falloff(focal, aperture, p->vignetting[0].k);
    return put_at(store, p);
}

static const char zoom[] = "Example EF 24-70mm f/1.8L USM";

static inline lensprof_store *zoom_store(const place *here) {
    static const double focals[] = {24, 35, 50, 70}, apertures[] = {1.8, 2.0, 2.8, 4.0, 5.6, 8.0};
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    assert_ok(lensprof_store_begin(store, NULL));
    for (int f = 0; f < 4; f++)
        for (int a = 0; a < 6; a++) put_falloff(store, zoom, focals[f], apertures[a], INFINITY);
    assert_ok(lensprof_store_commit(store, NULL));
    return store;
}

static lensprof_profile answered = {.struct_size = sizeof answered};
static lensprof_lookup how = {.struct_size = sizeof how};

static inline lensprof_status ask_with(lensprof_store *store, const lensprof_profile_key *key,
                                       const lensprof_lookup_options *options) {
    lensprof_error error;
    lensprof_lookup_init(&how);
    return lensprof_store_lookup(store, key, options, &answered, &how, &error);
}

static inline lensprof_status ask(lensprof_store *store, const char *lens, double focal, double aperture,
                                  double distance) {
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    const lensprof_profile_key key = zoom_profile(lens, focal, aperture, distance)->key;
    return ask_with(store, &key, &options);
}

static inline double worst_error(double focal, double aperture) {
    double k[3], worst = 0.0;
    true_falloff(focal, aperture, k);
    for (double r = 0.0; r <= 1.0; r += 0.05) {
        const lensprof_vignetting truth = {{k[0], k[1], k[2]}, {0.0, 0.0}};
        worst = fmax(worst, fabs(lensprof_vignetting_eval(&truth, r * r, NULL)
                                 - lensprof_vignetting_eval(&answered.vignetting[0], r * r, NULL)));
    }
    return worst;
}

#endif
