/* A call for every struct that grows, with that struct in any size and everything else as in the headers.
 *
 * Uses public headers only: the program growth.c is compiled with the headers of one version and runs with the library
 * of another, and tests/unit/test_growth.c varies sizes. Every call that returns OK checks its result. */
#ifndef LENSPROF_TESTS_GROWTH_CALLS_H
#define LENSPROF_TESTS_GROWTH_CALLS_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lensprof/lensprof.h>

#define IMAGES 4
#define PAIRS 600
#define WIDTH 160
#define HEIGHT 120

static const double true_ev[IMAGES] = {0.0, 0.8, -0.6, 0.3}, true_k1 = -0.3;
static int wrong_results; /* calls that returned OK with a wrong result */
static const char *store_path;

static void expect(int holds, const char *what) {
    if (holds) return;
    printf("WRONG: %s\n", what);
    wrong_results++;
}

static int is_near(double a, double b, double tolerance) { return fabs(a - b) <= tolerance; }

static double draw(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

/* The other structs of a call. */
typedef struct setting {
    lensprof_fit_image images[IMAGES];
    lensprof_fit_options fit;
    lensprof_flat_options flat;
    lensprof_flat_image card;
    lensprof_sample_options sample;
    lensprof_sample_image samples[2];
    lensprof_profile profile;
    lensprof_profile found;
    lensprof_lookup_options how;
    lensprof_lookup lookup;
    lensprof_pair pairs[PAIRS];
    lensprof_response linear;
    float pixels[2][HEIGHT][WIDTH];
} setting;

static setting here;

static void prepare_fit(void) {
    uint32_t state = 1, count = 0;
    for (uint32_t i = 0; i < IMAGES; i++) lensprof_fit_image_init(&here.images[i], i, WIDTH, HEIGHT);
    lensprof_fit_options_init(&here.fit);
    lensprof_response_set_linear(&here.linear);
    here.fit.channels = 1;
    here.fit.free = LENSPROF_FREE_K1;
    here.fit.response = &here.linear;
    here.fit.threads = 1;
    while (count < PAIRS) {
        lensprof_pair *pair = &here.pairs[count];
        const double radiance = 0.05 + 0.5 * draw(&state);
        pair->image[0] = count % IMAGES;
        pair->image[1] = (count + 1) % IMAGES;
        for (int side = 0; side < 2; side++) {
            double *xy = pair->xy[side];
            xy[0] = draw(&state) * (WIDTH - 1), xy[1] = draw(&state) * (HEIGHT - 1);
            const double x = xy[0] - 0.5 * (WIDTH - 1), y = xy[1] - 0.5 * (HEIGHT - 1), r2 = (x * x + y * y) / 1e4;
            const double value = radiance * (1.0 + true_k1 * r2) * pow(2.0, true_ev[pair->image[side]]);
            for (int c = 0; c < 3; c++) pair->value[side][c] = value;
        }
        if (pair->value[0][0] < 0.95 && pair->value[1][0] < 0.95) count++;
    }
}

/* A card seen through the falloff. */
static void prepare_card(void) {
    lensprof_flat_options_init(&here.flat);
    lensprof_flat_image_init(&here.card);
    here.flat.channels = 1;
    here.flat.free = LENSPROF_FREE_K1;
    here.flat.grid = LENSPROF_FLAT_GRID_NONE;
    here.flat.threads = 1;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double u = x - 0.5 * (WIDTH - 1), v = y - 0.5 * (HEIGHT - 1);
            here.pixels[0][y][x] = (float)(0.6 * (1.0 + true_k1 * (u * u + v * v) / 1e4));
        }
    const lensprof_image view = {here.pixels[0], sizeof here.pixels[0][0], WIDTH,
                                 HEIGHT,         LENSPROF_SAMPLE_F32,      LENSPROF_LAYOUT_GREY};
    here.card.view = view;
    here.card.width = WIDTH, here.card.height = HEIGHT;
}

/* Two pictures of one scene, 10 degrees apart. */
static void prepare_samples(void) {
    lensprof_sample_options_init(&here.sample);
    here.sample.pairs = 100;
    here.sample.threads = 1;
    for (int i = 0; i < 2; i++) {
        lensprof_sample_image *image = &here.samples[i];
        lensprof_sample_image_init(image);
        image->camera.width = WIDTH, image->camera.height = HEIGHT;
        image->camera.hfov_deg = 50.0, image->camera.yaw_deg = 10.0 * i;
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                double d[2] = {0.0, 0.0};
                (void)lensprof_camera_unproject(&image->camera, x, y, d);
                here.pixels[i][y][x] = (float)(0.5 + 0.2 * sin(17.0 * d[0] + 5.0 * d[1]) + 0.2 * cos(23.0 * d[1]));
            }
        const lensprof_image view = {here.pixels[i], sizeof here.pixels[i][0], WIDTH,
                                     HEIGHT,         LENSPROF_SAMPLE_F32,      LENSPROF_LAYOUT_GREY};
        image->view = view;
    }
}

static void fill_profile(lensprof_profile *profile) {
    strcpy(profile->key.lens, "Lens");
    profile->key.focal_mm = 50.0;
    profile->key.aperture = 2.0;
    profile->vignetting[0].k[0] = true_k1;
}

static void prepare_profiles(void) {
    lensprof_profile_init(&here.profile);
    lensprof_profile_init(&here.found);
    lensprof_lookup_options_init(&here.how);
    lensprof_lookup_init(&here.lookup);
    fill_profile(&here.profile);
}

/* ---- the calls: `given` is initialised, of any size ---- */

/* What a fit is asked for; NULL = nothing. */
typedef struct parts {
    lensprof_fit_result *result;
    lensprof_fit_image_quality *quality;
    lensprof_fit_camera *camera;
    lensprof_finding *finding;
} parts;

static lensprof_status fit(const lensprof_fit_options *options, const lensprof_fit_image *images, parts asked,
                           lensprof_error *error) {
    lensprof_exposure exposures[IMAGES];
    lensprof_fit *held = NULL;
    lensprof_status status =
        lensprof_fit_overlap(options, images, IMAGES, here.pairs, PAIRS, NULL, 0, exposures, &held, error);
    if (status != LENSPROF_OK) return status;
    for (int i = 1; i < IMAGES; i++) expect(is_near(exposures[i].ev, true_ev[i], 0.01), "exposure of a fit");
    if (asked.result) status = lensprof_fit_setting_at(held, 0, asked.result, error);
    if (status == LENSPROF_OK && asked.result)
        expect(is_near(asked.result->vignetting[0].k[0], true_k1, 0.01), "falloff of a fit");
    if (asked.quality) status = lensprof_fit_image_at(held, 1, asked.quality, error);
    if (status == LENSPROF_OK && asked.quality)
        expect(asked.quality->pairs == 2 * PAIRS / IMAGES, "pairs of an image's quality");
    if (asked.camera) status = lensprof_fit_camera_at(held, 0, asked.camera, error);
    if (status == LENSPROF_OK && asked.camera) expect(asked.camera->images == IMAGES, "images of a camera");
    if (asked.finding) status = lensprof_fit_finding_at(held, 0, 0, asked.finding, error);
    if (status == LENSPROF_OK && asked.finding) expect(asked.finding->code != 0, "code of a finding");
    lensprof_fit_destroy(held);
    return status;
}

static lensprof_status call_fit_options(void *given, lensprof_error *error) {
    lensprof_fit_options *options = given;
    options->channels = 1;
    options->free = LENSPROF_FREE_K1;
    options->response = &here.linear;
    options->threads = 1;
    return fit(options, here.images, (parts){0}, error);
}

static lensprof_status call_fit_images(void *given, lensprof_error *error) {
    return fit(&here.fit, given, (parts){0}, error);
}

static lensprof_status call_fit_result(void *given, lensprof_error *error) {
    return fit(&here.fit, here.images, (parts){.result = given}, error);
}

static lensprof_status call_fit_image_quality(void *given, lensprof_error *error) {
    return fit(&here.fit, here.images, (parts){.quality = given}, error);
}

static lensprof_status call_fit_camera(void *given, lensprof_error *error) {
    return fit(&here.fit, here.images, (parts){.camera = given}, error);
}

static lensprof_status call_finding(void *given, lensprof_error *error) {
    return fit(&here.fit, here.images, (parts){.finding = given}, error);
}

static lensprof_status flat(const lensprof_flat_options *options, const lensprof_flat_image *image,
                            lensprof_flat_result *result, lensprof_flat_image_quality *quality, lensprof_error *error) {
    prepare_card(); /* the pixels */
    lensprof_flat *held = NULL;
    lensprof_status status = lensprof_fit_flat(options, image, 1, NULL, 0, &held, error);
    if (status != LENSPROF_OK) return status;
    if (result) status = lensprof_flat_get(held, result, error);
    if (status == LENSPROF_OK && result)
        expect(is_near(result->vignetting[0].k[0], true_k1, 0.01), "falloff of a card");
    if (quality) status = lensprof_flat_image_at(held, 0, quality, error);
    if (status == LENSPROF_OK && quality) expect(quality->cells > 100, "cells of a picture's quality");
    lensprof_flat_destroy(held);
    return status;
}

static lensprof_status call_flat_options(void *given, lensprof_error *error) {
    lensprof_flat_options *options = given;
    options->channels = 1;
    options->free = LENSPROF_FREE_K1;
    options->grid = LENSPROF_FLAT_GRID_NONE;
    options->threads = 1;
    return flat(options, &here.card, NULL, NULL, error);
}

static lensprof_status call_flat_image(void *given, lensprof_error *error) {
    lensprof_flat_image *image = given;
    image->view = here.card.view;
    image->width = WIDTH, image->height = HEIGHT;
    return flat(&here.flat, image, NULL, NULL, error);
}

static lensprof_status call_flat_result(void *given, lensprof_error *error) {
    return flat(&here.flat, &here.card, given, NULL, error);
}

static lensprof_status call_flat_image_quality(void *given, lensprof_error *error) {
    return flat(&here.flat, &here.card, NULL, given, error);
}

static lensprof_status sample(const lensprof_sample_options *options, const lensprof_sample_image *images,
                              lensprof_error *error) {
    static lensprof_pair found[100];
    uint32_t count = 0;
    prepare_samples(); /* the pixels */
    const lensprof_status status = lensprof_sample_overlap(options, images, 2, found, 100, &count, error);
    if (status != LENSPROF_OK) return status;
    expect(count > 20, "pairs found");
    for (uint32_t p = 0; p < count; p++)
        expect(is_near(found[p].value[0][0], found[p].value[1][0], 0.02), "values of a pair");
    return status;
}

static lensprof_status call_sample_options(void *given, lensprof_error *error) {
    lensprof_sample_options *options = given;
    options->pairs = 100;
    options->threads = 1;
    return sample(options, here.samples, error);
}

/* An array of two elements: the second one is a struct_size further. */
static lensprof_status call_sample_images(void *given, lensprof_error *error) {
    lensprof_sample_image *first = given;
    lensprof_sample_image *second = (void *)((char *)given + first->struct_size);
    first->view = here.samples[0].view, first->camera = here.samples[0].camera;
    second->view = here.samples[1].view, second->camera = here.samples[1].camera;
    return sample(&here.sample, given, error);
}

static lensprof_status call_apply_options(void *given, lensprof_error *error) {
    static uint64_t memory[1 << 14];
    lensprof_apply_options *options = given;
    const lensprof_plan *plan;
    uint8_t pixel[3] = {100, 100, 100};
    const lensprof_target view = {pixel, 3, 1, 1, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
    options->frame_width = WIDTH, options->frame_height = HEIGHT;
    options->response = here.profile.response, options->vignetting = here.profile.vignetting;
    const size_t bytes = lensprof_plan_bytes(options);
    const lensprof_status status = lensprof_plan_init(memory, sizeof memory, options, &plan, error);
    expect((bytes > 0 && bytes <= sizeof memory) == (status == LENSPROF_OK), "bytes of a plan");
    if (status != LENSPROF_OK) return status;
    expect(lensprof_apply(plan, NULL, &view, 0, 0) == LENSPROF_OK, "apply");
    expect(pixel[1] == 142, "a corner's pixel");
    return status;
}

static lensprof_status with_store(lensprof_status (*call)(lensprof_store *, void *, lensprof_error *), void *given,
                                  lensprof_error *error) {
    lensprof_store *store;
    remove(store_path);
    lensprof_status status = lensprof_store_open(store_path, LENSPROF_STORE_CREATE, &store, error);
    if (status == LENSPROF_OK) {
        status = call(store, given, error);
        lensprof_store_close(store);
    }
    remove(store_path);
    return status;
}

/* As input: stored, packed, copied. */
static lensprof_status use_profile(lensprof_store *store, void *given, lensprof_error *error) {
    static uint8_t blob[1 << 15];
    static lensprof_profile copy;
    size_t bytes = 0;
    lensprof_profile *profile = given;
    fill_profile(profile);
    lensprof_profile_init(&copy);
    const lensprof_status status = lensprof_store_put(store, profile, NULL, error);
    expect(lensprof_profile_validate(profile) == status, "profile_validate");
    expect(lensprof_profile_pack(profile, 0, blob, sizeof blob, &bytes) == status, "profile_pack");
    expect(lensprof_profile_copy(&copy, profile) == status, "profile_copy");
    if (status == LENSPROF_OK) expect(copy.vignetting[0].k[0] == true_k1 && copy.covariance_size == 0, "the copy");
    return status;
}

/* As output: found, unpacked, refitted. */
static lensprof_status find_profile(lensprof_store *store, void *given, lensprof_error *error) {
    static uint8_t blob[1 << 15];
    size_t bytes = 0;
    lensprof_profile *profile = given;
    if (lensprof_store_put(store, &here.profile, NULL, error) != LENSPROF_OK) return LENSPROF_ERROR_STRUCT_SIZE;
    if (lensprof_profile_pack(&here.profile, 0, blob, sizeof blob, &bytes) != LENSPROF_OK)
        return LENSPROF_ERROR_ARGUMENT;
    const lensprof_status status = lensprof_store_get(store, 1, profile, error);
    if (status == LENSPROF_OK) expect(profile->vignetting[0].k[0] == true_k1, "the profile got");
    expect(lensprof_store_find(store, &here.profile.key, profile, NULL, error) == status, "store_find");
    expect(lensprof_profile_unpack(blob, bytes, profile) == status, "profile_unpack");
    if (status == LENSPROF_OK) expect(profile->vignetting[0].k[0] == true_k1, "the profile unpacked");
    return status;
}

static lensprof_status look_up(lensprof_store *store, const lensprof_lookup_options *options, lensprof_lookup *lookup,
                               lensprof_error *error) {
    lensprof_status status = lensprof_store_put(store, &here.profile, NULL, error);
    if (status == LENSPROF_OK)
        status = lensprof_store_lookup(store, &here.profile.key, options, &here.found, lookup, error);
    if (status != LENSPROF_OK) return status;
    expect(here.found.vignetting[0].k[0] == true_k1, "the profile looked up");
    expect(lookup->exact == 1 && lookup->rows == 1 && lookup->id[0] == 1 && lookup->reason[0] == 0, "the lookup");
    return status;
}

static lensprof_status use_lookup_options(lensprof_store *store, void *given, lensprof_error *error) {
    return look_up(store, given, &here.lookup, error);
}

static lensprof_status use_lookup(lensprof_store *store, void *given, lensprof_error *error) {
    return look_up(store, &here.how, given, error);
}

static lensprof_status use_stats(lensprof_store *store, void *given, lensprof_error *error) {
    lensprof_store_stats *stats = given;
    lensprof_status status = lensprof_store_put(store, &here.profile, NULL, error);
    if (status == LENSPROF_OK) status = lensprof_store_get_stats(store, stats, error);
    if (status == LENSPROF_OK) expect(stats->profiles == 1 && stats->lenses == 1 && stats->bytes > 4096, "the counts");
    return status;
}

static lensprof_status call_profile_in(void *given, lensprof_error *error) {
    return with_store(use_profile, given, error);
}
static lensprof_status call_profile_out(void *given, lensprof_error *error) {
    return with_store(find_profile, given, error);
}
static lensprof_status call_lookup_options(void *given, lensprof_error *error) {
    return with_store(use_lookup_options, given, error);
}
static lensprof_status call_lookup(void *given, lensprof_error *error) { return with_store(use_lookup, given, error); }
static lensprof_status call_stats(void *given, lensprof_error *error) { return with_store(use_stats, given, error); }

static lensprof_status call_pto_image(void *given, lensprof_error *error) {
    static const char text[] = "p f0 w100 h50 v90\ni w200 h100 f0 v50 Eev2 Er1 Eb1 n\"a.jpg\"\n";
    lensprof_pto *pto;
    lensprof_pto_image *image = given;
    if (lensprof_pto_read(text, sizeof text - 1, &pto, error) != LENSPROF_OK) return LENSPROF_ERROR_SYNTAX;
    const lensprof_status status = lensprof_pto_get_image(pto, 0, image, error);
    if (status == LENSPROF_OK) expect(image->camera.width == 200 && image->exposure.ev == -2.0, "the image");
    lensprof_pto_destroy(pto);
    return status;
}

static char json[1 << 15];

static lensprof_status call_export_options(void *given, lensprof_error *error) {
    lensprof_export_options *options = given;
    const lensprof_profile *const profiles[1] = {&here.profile};
    options->name = "a.json";
    return lensprof_export(profiles, 1, options, json, sizeof json, NULL, error);
}

static lensprof_status expect_entry(void *user, const lensprof_import_entry *entry) {
    (void)user;
    expect(entry->profile->vignetting[0].k[0] == true_k1, "the profile imported");
    return LENSPROF_OK;
}

static lensprof_status call_import_options(void *given, lensprof_error *error) {
    lensprof_import_options *options = given;
    lensprof_export_options written;
    lensprof_export_options_init(&written);
    const lensprof_status status = call_export_options(&written, error);
    if (status != LENSPROF_OK) return status;
    options->name = "a.json";
    return lensprof_import(json, strlen(json), options, expect_entry, NULL, error);
}

/* ---- all of them ---- */

static void init_zero(void *given, size_t size, uint32_t i) {
    (void)i;
    lensprof_init_sized(given, size);
}
#define INIT(x)                                                  \
    static void init_##x(void *given, size_t size, uint32_t i) { \
        (void)i;                                                 \
        lensprof_##x##_init_sized(given, size);                  \
    }
INIT(fit_options)
INIT(flat_options)
INIT(flat_image)
INIT(sample_options)
INIT(sample_image)
INIT(apply_options)
INIT(profile)
INIT(import_options)
INIT(export_options)

static void init_fit_image(void *given, size_t size, uint32_t i) {
    lensprof_fit_image_init_sized(given, size, i, WIDTH, HEIGHT);
}

typedef struct growing {
    const char *name;
    size_t size, first; /* in these headers, and in 0.3.0 with 64 bit addresses */
    uint32_t count;     /* number of elements, if it is an array */
    void (*init)(void *given, size_t size, uint32_t i);
    lensprof_status (*call)(void *given, lensprof_error *error);
    int has_text, is_output; /* errors have a text, and all members are written by the library */
} growing;

static const growing structs[] = {
    {"fit_options", sizeof(lensprof_fit_options), 160, 1, init_fit_options, call_fit_options, 1, 0},
    {"fit_image", sizeof(lensprof_fit_image), 104, IMAGES, init_fit_image, call_fit_images, 1, 0},
    {"finding", sizeof(lensprof_finding), 328, 1, init_zero, call_finding, 1, 1},
    {"fit_result", sizeof(lensprof_fit_result), 19472, 1, init_zero, call_fit_result, 1, 1},
    {"fit_image_quality", sizeof(lensprof_fit_image_quality), 96, 1, init_zero, call_fit_image_quality, 1, 1},
    {"fit_camera", sizeof(lensprof_fit_camera), 64, 1, init_zero, call_fit_camera, 1, 1},
    {"flat_options", sizeof(lensprof_flat_options), 128, 1, init_flat_options, call_flat_options, 1, 0},
    {"flat_image", sizeof(lensprof_flat_image), 104, 1, init_flat_image, call_flat_image, 1, 0},
    {"flat_result", sizeof(lensprof_flat_result), 24200, 1, init_zero, call_flat_result, 1, 1},
    {"flat_image_quality", sizeof(lensprof_flat_image_quality), 88, 1, init_zero, call_flat_image_quality, 1, 1},
    {"sample_options", sizeof(lensprof_sample_options), 40, 1, init_sample_options, call_sample_options, 1, 0},
    {"sample_image", sizeof(lensprof_sample_image), 224, 2, init_sample_image, call_sample_images, 1, 0},
    {"apply_options", sizeof(lensprof_apply_options), 176, 1, init_apply_options, call_apply_options, 1, 0},
    {"profile as input", sizeof(lensprof_profile), 49312, 1, init_profile, call_profile_in, 1, 0},
    {"profile as output", sizeof(lensprof_profile), 49312, 1, init_profile, call_profile_out, 1, 1},
    {"lookup_options", sizeof(lensprof_lookup_options), 16, 1, init_zero, call_lookup_options, 1, 0},
    {"lookup", sizeof(lensprof_lookup), 680, 1, init_zero, call_lookup, 1, 1},
    {"store_stats", sizeof(lensprof_store_stats), 4336, 1, init_zero, call_stats, 1, 1},
    {"pto_image", sizeof(lensprof_pto_image), 312, 1, init_zero, call_pto_image, 1, 1},
    {"import_options", sizeof(lensprof_import_options), 64, 1, init_import_options, call_import_options, 1, 0},
    {"export_options", sizeof(lensprof_export_options), 56, 1, init_export_options, call_export_options, 1, 0},
};
#define STRUCTS (sizeof structs / sizeof *structs)

/* An array of initialised structs of `size` bytes each, and nothing after them; free() it. */
static void *new_structs(const growing *g, size_t size) {
    char *given = malloc(size * g->count);
    if (!given) exit(1);
    for (uint32_t i = 0; i < g->count; i++) g->init(given + i * size, size, i);
    return given;
}

static void prepare(void) {
    prepare_fit();
    prepare_card();
    prepare_samples();
    prepare_profiles();
}

#endif
