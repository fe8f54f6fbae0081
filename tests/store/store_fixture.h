/* A separate directory for every test, and profiles to store. */
#ifndef LENSPROF_TESTS_STORE_FIXTURE_H
#define LENSPROF_TESTS_STORE_FIXTURE_H

#include "support.h"

#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <linux/fs.h>
#include <sqlite3.h>
#include <stdbool.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "store/file/private.h"

typedef struct place {
    char directory[128];
    char path[160]; /* of the database */
} place;

/* Makes a file or directory unwritable, even for root, who ignores permission bits (tests in a container run as root),
 * with the immutable flag of the file system. Returns false if this is not possible; such tests are skipped. */
static inline bool set_protected(const char *path, bool on) {
    int flags, descriptor = open(path, O_RDONLY);
    if (descriptor < 0) return false;
    bool done = ioctl(descriptor, FS_IOC_GETFLAGS, &flags) == 0;
    flags = on ? flags | FS_IMMUTABLE_FL : flags & ~FS_IMMUTABLE_FL;
    done = done && ioctl(descriptor, FS_IOC_SETFLAGS, &flags) == 0;
    close(descriptor);
    if (done || geteuid() == 0) return done;
    struct stat status;
    if (stat(path, &status)) return false;
    mode_t write = S_IWUSR | S_IWGRP | S_IWOTH;
    return chmod(path, on ? status.st_mode & ~write : status.st_mode | S_IWUSR) == 0;
}

static inline int place_setup(void **state) {
    place *here = calloc(1, sizeof *here);
    const char *base = getenv("TMPDIR");
    snprintf(here->directory, sizeof here->directory, "%.90s/lensprof-store-XXXXXX", base ? base : "/tmp");
    if (!mkdtemp(here->directory)) return -1;
    snprintf(here->path, sizeof here->path, "%s/profiles.db", here->directory);
    *state = here;
    return 0;
}

static inline int place_teardown(void **state) {
    place *here = *state;
    char path[600];
    struct dirent *entry;
    (void)set_protected(here->directory, false);
    DIR *directory = opendir(here->directory);
    while (directory && (entry = readdir(directory))) {
        snprintf(path, sizeof path, "%s/%s", here->directory, entry->d_name);
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        if (unlink(path) == 0 || rmdir(path) == 0) continue;
        (void)set_protected(path, false);
        unlink(path);
    }
    if (directory) closedir(directory);
    rmdir(here->directory);
    free(here);
    return 0;
}

#define store_test(function) cmocka_unit_test_setup_teardown(function, place_setup, place_teardown)

/* Opens the database, or fails the test with the library's error text. */
static inline lensprof_store *store_at(const char *path, uint32_t mode) {
    lensprof_store *store = NULL;
    lensprof_error error;
    if (lensprof_store_open(path, mode, &store, &error) != LENSPROF_OK) fail_msg("%s", error.text);
    return store;
}

/* Another database in the same directory. */
static inline lensprof_store *store_in(const place *here, const char *name, uint32_t mode) {
    char path[300];
    snprintf(path, sizeof path, "%s/%s", here->directory, name);
    return store_at(path, mode);
}

/* The database, created if missing, and another one in the same directory. */
static inline void open_pair(const place *here, const char *other_name, uint32_t other_mode, lensprof_store **store,
                             lensprof_store **other) {
    *store = store_at(here->path, LENSPROF_STORE_CREATE);
    *other = store_in(here, other_name, other_mode);
}

static inline void close_pair(lensprof_store *store, lensprof_store *other) {
    lensprof_store_close(other);
    lensprof_store_close(store);
}

static inline int64_t put_at(lensprof_store *store, const lensprof_profile *profile) {
    int64_t id = 0;
    lensprof_error error;
    if (lensprof_store_put(store, profile, &id, &error) != LENSPROF_OK) fail_msg("%s", error.text);
    return id;
}

/* Runs SQL on the file without the library. */
static inline void run_sql(const char *path, const char *sql) {
    sqlite3 *db;
    char *message = NULL;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    if (sqlite3_exec(db, sql, NULL, NULL, &message)) fail_msg("%s: %s", sql, message);
    sqlite3_close(db);
}

static inline void assert_integrity(const char *path) {
    sqlite3 *db;
    sqlite3_stmt *statement;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db, "PRAGMA integrity_check", -1, &statement, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
    assert_string_equal((const char *)sqlite3_column_text(statement, 0), "ok");
    sqlite3_finalize(statement);
    assert_int_equal(sqlite3_prepare_v2(db, "PRAGMA foreign_key_check", -1, &statement, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(statement), SQLITE_DONE);
    sqlite3_finalize(statement);
    sqlite3_close(db);
}

/* The whole file in memory; the caller frees it. */
static inline unsigned char *read_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*size + 1);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

static inline void write_file(const char *path, const void *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

static inline void assert_file(const char *path, const void *expected, size_t size) {
    size_t found;
    unsigned char *bytes = read_file(path, &found);
    assert_int_equal(found, size);
    assert_memory_equal(bytes, expected, size);
    free(bytes);
}

/* A file of an older layout, as an older lensprof wrote it, with these profiles except members it cannot hold: up to
 * layout 3, prior_id and forced are at the end of the method. */
static inline void make_layout(const char *path, int layout, const lensprof_profile *profiles, size_t count) {
    static const char *const schemas[] = {lp_schema_0001, lp_schema_0002, lp_schema_0003,
                                          lp_schema_0004, lp_schema_0005, lp_schema_0006},
                             *const added[] = {
                                 "",
                                 ", gain_grids",
                                 ", gain_grids, unit, crop_factor, doubt, lens_name",
                                 (", gain_grids, unit, crop_factor, doubt, lens_name, color_temperature_k,"
                                  " prior_id, forced"),
                                 (", gain_grids, unit, crop_factor, doubt, lens_name, color_temperature_k,"
                                  " prior_id, forced, style, gamma_sigma"),
                                 (", gain_grids, unit, crop_factor, doubt, lens_name, color_temperature_k,"
                                  " prior_id, forced, style, gamma_sigma, black_red, black_green, black_blue,"
                                  " white_level")};
    const char *method =
        layout < 4 ? "method || ifnull('+' || prior_id, '') || iif(forced, ' (forced)', '')" : "method";
    char newer[400], sql[2000];
    snprintf(newer, sizeof newer, "%s.newer", path);
    lensprof_store *store = store_at(newer, LENSPROF_STORE_CREATE);
    for (size_t i = 0; i < count; i++) put_at(store, &profiles[i]);
    lensprof_store_close(store);
    for (int i = 0; i < layout; i++) run_sql(path, schemas[i]);
    snprintf(
        sql, sizeof sql,
        "ATTACH '%s' AS newer; BEGIN; INSERT INTO main.profiles SELECT id, camera_maker, camera_model, lens, focal_mm,"
        " aperture, distance_m, processing, %s, software, source, created_unix_s, images, pairs, heldout_rms, inlier_share, response_curves,"
        " vignetting_curves, covariance_size, covariance%s FROM newer.profiles;"
        " INSERT INTO main.responses SELECT * FROM newer.responses;"
        " INSERT INTO main.emor_coefficients SELECT * FROM newer.emor_coefficients;"
        " INSERT INTO main.vignettings SELECT * FROM newer.vignettings; %s; COMMIT",
        newer, method, added[layout - 1],
        layout < 2 ? "" : "INSERT INTO main.gain_grids SELECT * FROM newer.gain_grids");
    run_sql(path, sql);
    unlink(newer);
}

/* Removes from a profile what only layouts newer than `layout`, 4 to 6, can hold. */
static inline void lose_newer(lensprof_profile *profile, int layout) {
    memset(&profile->image_circle, 0, sizeof profile->image_circle);
    if (layout >= 6) return;
    memset(&profile->levels, 0, sizeof profile->levels);
    if (layout >= 5) return;
    memset(profile->key.style, 0, sizeof profile->key.style);
    profile->provenance.gamma_sigma = 0.0;
}

static inline uint32_t count_at(lensprof_store *store) {
    uint32_t found = UINT32_MAX;
    lensprof_error error;
    if (lensprof_store_list(store, NULL, NULL, 0, &found, &error) != LENSPROF_OK) fail_msg("%s", error.text);
    return found;
}

/* A gain grid of values 3/n, few of which are decimal numbers. */
static inline void fill_grid(lensprof_gain_grid *grid, uint32_t columns, uint32_t rows, uint32_t channels) {
    lensprof_gain_grid_init(grid);
    grid->columns = columns, grid->rows = rows, grid->channels = channels;
    for (uint32_t i = 0; i < columns * rows * channels; i++) grid->attenuation[i] = 3.0f / (float)(i % 1000 + 7);
}

/* An initialised profile; free() it. */
static inline lensprof_profile *new_profile(void) {
    lensprof_profile *profile = malloc(sizeof *profile);
    lensprof_profile_init(profile);
    return profile;
}

/* An output of which every byte must be written. */
static inline void scribble(lensprof_profile *profile) {
    memset(profile, 0x5A, sizeof *profile);
    profile->struct_size = sizeof *profile;
}

/* A profile with something in every field: EMoR, one curve, gain grid, covariance 10 x 10. */
static inline void fill_profile(lensprof_profile *profile) {
    static const double coefficients[] = {-0.625, 0.1, -0.05, 0.02, 1.0 / 30.0};
    lensprof_profile_init(profile);
    strcpy(profile->key.camera_maker, "Canon");
    strcpy(profile->key.camera_model, "EOS 5D Mark II");
    strcpy(profile->key.lens, "EF24-70mm f/2.8L \xc3\xa9 'quoted'; --");
    profile->key.focal_mm = 24.1;
    profile->key.aperture = 2.8;
    profile->key.distance_m = 3.3;
    profile->key.color_temperature_k = 4321.5;
    strcpy(profile->key.style, "Fine Detail");
    strcpy(profile->provenance.method, "transfer");
    strcpy(profile->provenance.software, "lensprof 0.1.0");
    strcpy(profile->provenance.source, "/data/pano \xe2\x82\xac/IMG_1.JPG");
    profile->provenance.created_unix_s = 1754000000;
    profile->provenance.images = 7;
    profile->provenance.pairs = UINT32_MAX;
    profile->provenance.heldout_rms = 2.1;
    profile->provenance.inlier_share = 0.93;
    profile->provenance.forced = 1;
    profile->provenance.gamma_sigma = 0.1 / 3.0;
    assert_ok(lensprof_response_set_emor(&profile->response[0], coefficients, 5));
    profile->vignetting[0] = (lensprof_vignetting){{-0.3, 0.1, -0.1 / 3.0}, {0.01, -0.02}};
    fill_grid(&profile->grid, 5, 4, 1);
    profile->image_circle = (lensprof_image_circle){{1.0 / 300.0, -0.01}, 0.9};
    profile->levels = (lensprof_levels){{256.0 / 65535.0, 0.0, -0.001}, 4095.0 / 65535.0};
    profile->covariance_size = 10;
    for (uint32_t i = 0; i < 10; i++)
        for (uint32_t j = 0; j < 10; j++) profile->covariance[10 * i + j] = i == j ? 1.0 / 7.0 : -1e-9 / (1.0 + i + j);
}

/* Compares the values of two profiles to the bit; curves beyond the count do not matter. */
static inline void assert_same_profile(const lensprof_profile *a, const lensprof_profile *b) {
    assert_memory_equal(&a->key, &b->key, sizeof a->key);
    assert_memory_equal(&a->provenance, &b->provenance, sizeof a->provenance);
    assert_int_equal(a->responses, b->responses);
    assert_int_equal(a->vignettings, b->vignettings);
    assert_memory_equal(a->response, b->response, a->responses * sizeof *a->response);
    assert_memory_equal(a->vignetting, b->vignetting, a->vignettings * sizeof *a->vignetting);
    assert_memory_equal(&a->grid, &b->grid, sizeof a->grid);
    assert_memory_equal(&a->levels, &b->levels, sizeof a->levels);
    assert_memory_equal(&a->image_circle, &b->image_circle, sizeof a->image_circle);
    assert_int_equal(a->covariance_size, b->covariance_size);
    assert_memory_equal(a->covariance, b->covariance, a->covariance_size * a->covariance_size * sizeof(double));
}

/* Whether a lookup reports a reason, with these words in its text. */
static inline int has_reason(const lensprof_lookup *how, lensprof_reason code, const char *words) {
    int found = 0;
    for (int i = 0; i < LENSPROF_LOOKUP_REASONS; i++) found |= how->reason_code[i] == (uint32_t)code;
    if (!found || !strstr(how->reason, words)) print_error("no \"%s\" (%d) in \"%s\"\n", words, code, how->reason);
    return found && strstr(how->reason, words) != NULL;
}

#endif
