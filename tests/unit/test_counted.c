/* Results of variable length follow one rule (lensprof/base.h): capacity 0 asks for *count, a buffer of exactly that
 * size suffices, and one element less is refused with CAPACITY, *count and a text, leaving the buffer untouched. The
 * table holds every public function with a capacity; test_table_is_complete counts them. */
#include "support.h"

#include <glob.h>
#include <unistd.h>

#include "formats/each_format.h"
#include "install/growth/calls.h"

static const char project[] =
    "p f2 w1000 h500 v180 n\"TIFF\"\n"
    "i w160 h120 f0 v50 Va1 Vb-0.3 Vc0 Vd0 r0 p0 y0 Eev10 Er1 Eb1 n\"a picture.jpg\"\n";
static const char point_lines[] = "0 1 1 2 3 4 .1 .1 .1 .2 .2 .2 0 1 2 0\n0 1 5 6 7 8 .1 .1 .1 .2 .2 .2 0 1 2 0\n";

static lensprof_pto *pto;
static lensprof_store *store;
static const lensprof_profile *const profiles[1] = {&here.profile};
static const lensprof_pair one_pair = {{0, 1}, {{10, 10}, {20, 20}}, {{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}}};
static const lensprof_match one_match = {{0, 1}, {{40, 30}, {40, 30}}, {{0}}};
static const lensprof_camera cameras[2] = {{.width = WIDTH, .height = HEIGHT}, {.width = WIDTH, .height = HEIGHT}};
static lensprof_export_options as_json;
static lensprof_exposures_info exposures;
static lensprof_exposures_camera one_camera;
static lensprof_exposures_lens one_lens;
static lensprof_exposures_image one_image;

/* name(buffer, capacity, count, error) for the table, for bytes and for elements. */
#define BYTES(name, call) \
    static lensprof_status name(void *b, size_t capacity, size_t *count, lensprof_error *error) { return call; }
#define ELEMENTS(name, call)                                                                   \
    static lensprof_status name(void *b, size_t given, size_t *total, lensprof_error *error) { \
        const uint32_t capacity = (uint32_t)given;                                             \
        uint32_t found = (uint32_t)*total, *count = &found;                                    \
        const lensprof_status status = call;                                                   \
        *total = found;                                                                        \
        return status;                                                                         \
    }

BYTES(pto_get_name, lensprof_pto_get_name(pto, 0, b, capacity, count, error))
BYTES(pto_write, lensprof_pto_write(pto, b, capacity, count, error))
BYTES(exposures_write,
      lensprof_exposures_write(&exposures, &one_camera, &one_lens, &one_image, b, capacity, count, error))
BYTES(points_write, lensprof_points_write(&one_pair, 1, cameras, 2, b, capacity, count, error))
BYTES(lensfun_write, lp_lensfun_write(profiles, 1, NULL, b, capacity, count, error))
BYTES(json_write, lp_json_write(profiles, 1, b, capacity, count, error))
BYTES(lcp_write, lp_lcp_write(profiles, 1, 0, 0, b, capacity, count, error))
BYTES(pcalib_write, lp_pcalib_write(&here.linear, b, capacity, count, error))
BYTES(curves_write, lp_curves_write(&here.linear, 1, 0, 16, b, capacity, count, error))
BYTES(cube_write, lp_cube_write(&here.profile, LENSPROF_CURVE_INVERSE, 16, b, capacity, count, error))
BYTES(shader_write, lp_shader_write(&here.profile, LENSPROF_FORMAT_GLSL, b, capacity, count, error))
BYTES(c_header_write, lp_c_header_write(&here.profile, b, capacity, count, error))
BYTES(alsc_write, lp_alsc_write(&here.profile, 5000, 4, 3, WIDTH, HEIGHT, b, capacity, count, error))
BYTES(radical_response_write, lp_radical_response_write(&here.linear, 1, b, capacity, count, error))
BYTES(radical_vignetting_write, lp_radical_vignetting_write(&here.profile, WIDTH, HEIGHT, b, capacity, count, error))
BYTES(dng_opcodes_write, lp_dng_opcodes_write(&here.profile, WIDTH, HEIGHT, LENSPROF_LAYOUT_RGB, LENSPROF_DNG_RADIAL, b,
                                              capacity, count, NULL, error))
BYTES(export, lensprof_export(profiles, 1, &as_json, b, capacity, count, error))
BYTES(profile_pack, (snprintf(error->text, sizeof error->text, "-"),
                     lensprof_profile_pack(&here.profile, 0, b, capacity, count))) /* reports no text */
ELEMENTS(points_read, lensprof_points_read(point_lines, sizeof point_lines - 1, b, capacity, count, error))
ELEMENTS(store_list, lensprof_store_list(store, NULL, b, capacity, count, error))
ELEMENTS(store_list_names, lensprof_store_list_names(store, LENSPROF_NAMES_LENSES, NULL, b, capacity, count, error))
ELEMENTS(store_list_camera_models, lensprof_store_list_camera_models(store, b, capacity, count, error))
ELEMENTS(sample_overlap, lensprof_sample_overlap(&here.sample, here.samples, 2, b, capacity, count, error))
ELEMENTS(sample_matches,
         lensprof_sample_matches(&here.sample, here.samples, 2, &one_match, 1, b, capacity, count, error))
ELEMENTS(sample_tracks, lensprof_sample_tracks(&here.sample, here.samples, 2, b, capacity, count, error))

#define ROW(name, element, kind) \
    { "lensprof_" #name, name, element, kind }
enum {
    TEXT,   /* with a terminator if there is room */
    OTHERS, /* bytes or elements, exactly *count of them */
    UP_TO   /* with capacity 0, *count is an upper bound */
};
static const struct {
    const char *name;
    lensprof_status (*call)(void *buffer, size_t capacity, size_t *count, lensprof_error *error);
    size_t element;
    int kind;
} table[] = {
    ROW(pto_get_name, 1, TEXT),
    ROW(pto_write, 1, TEXT),
    ROW(exposures_write, 1, TEXT),
    ROW(points_write, 1, TEXT),
    ROW(lensfun_write, 1, TEXT),
    ROW(json_write, 1, TEXT),
    ROW(lcp_write, 1, TEXT),
    ROW(pcalib_write, 1, TEXT),
    ROW(curves_write, 1, TEXT),
    ROW(cube_write, 1, TEXT),
    ROW(shader_write, 1, TEXT),
    ROW(c_header_write, 1, TEXT),
    ROW(alsc_write, 1, TEXT),
    ROW(radical_response_write, 1, OTHERS),
    ROW(radical_vignetting_write, 1, OTHERS),
    ROW(dng_opcodes_write, 1, OTHERS),
    ROW(export, 1, TEXT),
    ROW(profile_pack, 1, OTHERS),
    ROW(points_read, sizeof(lensprof_pair), OTHERS),
    ROW(store_list, sizeof(lensprof_store_row), OTHERS),
    ROW(store_list_names, sizeof(lensprof_store_summary), OTHERS),
    ROW(store_list_camera_models, sizeof(lensprof_camera_model), OTHERS),
    ROW(sample_overlap, sizeof(lensprof_pair), UP_TO),
    ROW(sample_matches, sizeof(lensprof_pair), UP_TO),
    ROW(sample_tracks, sizeof(lensprof_observation), UP_TO),
};
#define ROWS (sizeof table / sizeof *table)

static int setup(void **state) {
    static char directory[] = "/tmp/lensprof-counted-XXXXXX", path[64];
    (void)state;
    lensprof_error error;
    lensprof_camera_model camera;
    lensprof_camera_model_init(&camera);
    if (!mkdtemp(directory)) return -1;
    snprintf(path, sizeof path, "%s/profiles.db", directory);
    store_path = path;
    prepare();
    lensprof_export_options_init(&as_json);
    as_json.format = LENSPROF_FORMAT_JSON;
    lensprof_exposures_info_init(&exposures), lensprof_exposures_camera_init(&one_camera);
    lensprof_exposures_lens_init(&one_lens), lensprof_exposures_image_init(&one_image);
    exposures.camera_count = exposures.lens_count = exposures.image_count = 1;
    one_image.width = WIDTH, one_image.height = HEIGHT, one_image.name = "a.jpg";
    here.sample.pairs = 50;
    here.sample.threads = 1;
    here.profile.key.crop_factor = 1.5, here.profile.key.focal_mm = 50.0, here.profile.key.aperture = 2.8;
    if (lensprof_pto_read(project, sizeof project - 1, &pto, &error) != LENSPROF_OK
        || lensprof_store_open(path, LENSPROF_STORE_CREATE, &store, &error) != LENSPROF_OK)
        return -1;
    for (int i = 0; i < 3; i++) {
        snprintf(here.profile.key.lens, sizeof here.profile.key.lens, "Maker %dmm f/1.8", 50 - 10 * i);
        snprintf(here.profile.key.camera_model, sizeof here.profile.key.camera_model, "Camera %d", i);
        snprintf(camera.model, sizeof camera.model, "Camera %d", i);
        if (lensprof_store_put(store, &here.profile, NULL, &error) != LENSPROF_OK
            || lensprof_store_put_camera(store, &camera, &error) != LENSPROF_OK)
            return -1;
    }
    return 0;
}

static int teardown(void **state) {
    (void)state;
    char folder[64];
    lensprof_store_close(store);
    lensprof_pto_destroy(pto);
    remove(store_path);
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(store_path, '/') - store_path), store_path);
    return rmdir(folder);
}

/* The buffer is exactly as long as the capacity, so that a sanitizer detects writes after its end. */
static void check_row(size_t row, size_t wanted, size_t capacity) {
    const char *name = table[row].name;
    const size_t bytes = capacity * table[row].element;
    unsigned char *buffer = malloc(bytes);
    size_t count = 77;
    lensprof_error error = {.text = "?"};
    memset(buffer, 0x55, bytes);
    const lensprof_status status = table[row].call(buffer, capacity, &count, &error);
    if (status != (capacity < wanted ? LENSPROF_ERROR_CAPACITY : LENSPROF_OK))
        fail_msg("%s with capacity %zu of %zu: %s", name, capacity, wanted, lensprof_status_name(status));
    if (table[row].kind == UP_TO && capacity >= wanted ? !count || count > wanted : count != wanted)
        fail_msg("%s with capacity %zu of %zu: count %zu", name, capacity, wanted, count);
    for (size_t at = 0; at < bytes && capacity < wanted; at++)
        if (buffer[at] != 0x55)
            fail_msg("%s with capacity %zu of %zu: byte %zu is written", name, capacity, wanted, at);
    if (capacity < wanted && !*error.text) fail_msg("%s: no text", name);
    if (capacity > wanted && table[row].kind == TEXT && (buffer[wanted] || strlen((char *)buffer) != wanted))
        fail_msg("%s: terminator is missing", name);
    free(buffer);
}

static void test_every_capacity(void **state) {
    (void)state;
    for (size_t row = 0; row < ROWS; row++) {
        size_t wanted = 0;
        lensprof_error error = {.text = "?"};
        const lensprof_status status = table[row].call(NULL, 0, &wanted, &error);
        if (status != LENSPROF_OK) fail_msg("%s: %s %s", table[row].name, lensprof_status_name(status), error.text);
        if (wanted < 2) fail_msg("%s: count %zu", table[row].name, wanted);
        check_row(row, wanted, wanted);
        check_row(row, wanted, wanted - 1);
        check_row(row, wanted, 1);
        check_row(row, wanted, wanted + 1);
    }
}

static void test_count_of_bytes_may_be_null(void **state) {
    (void)state;
    static char buffer[1 << 18];
    lensprof_error error;
    for (size_t row = 0; row < ROWS; row++)
        if (table[row].element == 1) assert_ok(table[row].call(buffer, sizeof buffer, NULL, &error));
}

static void test_buffer_is_needed(void **state) {
    (void)state;
    for (size_t row = 0; row < ROWS; row++) {
        size_t count = 0;
        lensprof_error error = {.text = ""};
        if (table[row].call(NULL, 1, &count, &error) != LENSPROF_ERROR_ARGUMENT || !*error.text)
            fail_msg("%s: %s", table[row].name, error.text);
    }
}

/* Declarations with a capacity all have the same form. */
static void test_table_is_complete(void **state) {
    (void)state;
    static char text[1 << 17];
    size_t found = 0;
    glob_t headers;
    assert_int_equal(glob(LENSPROF_INCLUDE "/lensprof/*.h", 0, NULL, &headers), 0);
    assert_int_equal(glob(LENSPROF_INCLUDE "/../src/formats/each_format.h", GLOB_APPEND, NULL, &headers), 0);
    for (size_t h = 0; h < headers.gl_pathc; h++) {
        if (strstr(headers.gl_pathv[h], "/photo.h")) continue; /* of another library: tests/cli/test_photo.cpp */
        FILE *file = fopen(headers.gl_pathv[h], "rb");
        assert_non_null(file);
        text[fread(text, 1, sizeof text - 1, file)] = 0;
        fclose(file);
        for (char *at = text; (at = strstr(at, "_t capacity,")); at++) {
            found++;
            const char *next = at + strlen("_t capacity,");
            next += strspn(next, " \n");
            if (strncmp(next, "size_t *count", 13) && strncmp(next, "uint32_t *count", 15))
                fail_msg("%s: a capacity is followed by %.20s instead of *count", headers.gl_pathv[h], next);
        }
    }
    globfree(&headers);
    assert_int_equal(found, ROWS);
    free(new_structs(&structs[0], structs[0].size)); /* of the header, which has more than this test needs */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_capacity),
        cmocka_unit_test(test_count_of_bytes_may_be_null),
        cmocka_unit_test(test_buffer_is_needed),
        cmocka_unit_test(test_table_is_complete),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
