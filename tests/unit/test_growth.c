/* Structs that grow, in every size: nothing after them is written, and a size that no version has is refused with a
 * text. In the sanitized build the library's structs are longer than their first version (cmake/longer_headers.py), and
 * ASan watches. */
#include "support.h"

#include <unistd.h>

#include "install/growth/calls.h"

#define GUARD 64 /* bytes after a struct that an _init_sized function must not touch */

static char directory[] = "/tmp/lensprof-growth-XXXXXX", path[64];

static int make_directory(void **state) {
    (void)state;
    if (!mkdtemp(directory)) return -1;
    snprintf(path, sizeof path, "%s/profiles.db", directory);
    store_path = path;
    return 0;
}

static int remove_directory(void **state) {
    (void)state;
    return rmdir(directory);
}

/* For ABIs with 64 bit addresses: the struct sizes of 0.3.0 remain the first version for ever. */
static void test_first_sizes_stay(void **state) {
    (void)state;
    for (size_t i = 0; sizeof(void *) == 8 && i < STRUCTS; i++)
        if (structs[i].size < structs[i].first) fail_msg("%s has %zu bytes", structs[i].name, structs[i].size);
    assert_int_equal(sizeof(lensprof_profile_key), 512);
    assert_int_equal(sizeof(lensprof_provenance), 768);
}

static void test_init_writes_the_size_and_no_more(void **state) {
    (void)state;
    for (size_t i = 0; i < STRUCTS; i++) {
        const growing *g = &structs[i];
        const size_t sizes[] = {0, 3, 4, 8, g->first - 8, g->first, g->size, g->size + 8, g->size + 1000};
        for (size_t n = 0; n < sizeof sizes / sizeof *sizes; n++) {
            const size_t size = sizes[n];
            unsigned char *memory = malloc(size + GUARD);
            memset(memory, 0xA5, size + GUARD);
            g->init(memory, size, 0);
            for (size_t at = size < 4 ? 0 : size; at < size + GUARD; at++)
                if (memory[at] != 0xA5) fail_msg("%s of %zu bytes: byte %zu is written", g->name, size, at);
            if (size >= 4) assert_int_equal(*(uint32_t *)(void *)memory, size);
            for (size_t at = g->size; at < size; at++) /* members of a newer program's struct are unknown */
                if (memory[at]) fail_msg("%s of %zu bytes: byte %zu is not 0", g->name, size, at);
            free(memory);
        }
    }
}

/* Every size from the first version on works, in memory of exactly that size. */
static void test_sizes_of_older_programs(void **state) {
    (void)state;
    for (size_t i = 0; i < STRUCTS; i++)
        for (size_t size = structs[i].first; size <= structs[i].size; size += 8) {
            lensprof_error error = {"", {0, 0, 0, 0}};
            prepare();
            wrong_results = 0;
            char *given = new_structs(&structs[i], size);
            const lensprof_status status = structs[i].call(given, &error);
            if (status != LENSPROF_OK)
                fail_msg("%s of %zu bytes: %s %s", structs[i].name, size, lensprof_status_name(status), error.text);
            assert_int_equal(wrong_results, 0);
            for (uint32_t n = 0; n < structs[i].count; n++)
                assert_int_equal(*(uint32_t *)(void *)(given + n * size), size); /* unchanged */
            free(given);
        }
}

static void refuse(const growing *g, size_t size, const char *why) {
    lensprof_error error = {"", {0, 0, 0, 0}};
    prepare();
    wrong_results = 0;
    /* A call may fill in its members before the library checks the size. */
    const size_t room = size > g->size ? size : g->size;
    char *given = calloc(g->count, room);
    for (uint32_t n = 0; n < g->count; n++) g->init(given + n * size, size, n);
    const lensprof_status status = g->call(given, &error);
    if (status != LENSPROF_ERROR_STRUCT_SIZE)
        fail_msg("%s of %zu bytes: %s", g->name, size, lensprof_status_name(status));
    if (g->has_text && !strstr(error.text, why)) fail_msg("%s of %zu bytes: %s", g->name, size, error.text);
    assert_int_equal(wrong_results, 0);
    free(given);
}

static void test_other_sizes_are_refused(void **state) {
    (void)state;
    for (size_t i = 0; i < STRUCTS; i++) {
        refuse(&structs[i], structs[i].size + 8, "newer lensprof");
        refuse(&structs[i], structs[i].first - 8, "");
    }
}

static void test_elements_have_one_size(void **state) {
    (void)state;
    lensprof_error error;
    prepare();
    here.images[2].struct_size = 0; /* _init forgotten */
    assert_int_equal(fit(&here.fit, here.images, (parts){0}, &error), LENSPROF_ERROR_STRUCT_SIZE);
    assert_non_null(strstr(error.text, "image 2: struct_size"));
    here.samples[1].struct_size += 8;
    assert_int_equal(lensprof_sample_overlap(&here.sample, here.samples, 2, NULL, 0, &(uint32_t){0}, &error),
                     LENSPROF_OK); /* asks for the capacity: no picture is read */
    lensprof_pair pairs[100];
    assert_int_equal(lensprof_sample_overlap(&here.sample, here.samples, 2, pairs, 100, &(uint32_t){0}, &error),
                     LENSPROF_ERROR_STRUCT_SIZE);
    assert_non_null(strstr(error.text, "image 1: struct_size"));
}

/* Reserved room for future members: a nonzero value comes from a newer lensprof. */
static void test_reserved_room_is_empty(void **state) {
    (void)state;
    prepare();
    uint32_t *last_of_key = (uint32_t *)(&here.profile.key + 1) - 1;
    uint32_t *last_of_provenance = (uint32_t *)(&here.profile.provenance + 1) - 1;
    assert_int_equal(lensprof_profile_validate(&here.profile), LENSPROF_OK);
    *last_of_key = 1;
    assert_int_equal(lensprof_profile_validate(&here.profile), LENSPROF_ERROR_ARGUMENT);
    *last_of_key = 0;
    *last_of_provenance = 1;
    assert_int_equal(lensprof_profile_validate(&here.profile), LENSPROF_ERROR_ARGUMENT);
    *last_of_provenance = 0;
    here.profile.provenance.forced = 2;
    assert_int_equal(lensprof_profile_validate(&here.profile), LENSPROF_ERROR_ARGUMENT);
    here.profile.provenance.forced = 1;
    here.profile.provenance.prior_id = -1;
    assert_int_equal(lensprof_profile_validate(&here.profile), LENSPROF_ERROR_ARGUMENT);
    here.profile.provenance.prior_id = 7;
    here.profile.key.color_temperature_k = 0.0;
    assert_int_equal(lensprof_profile_validate(&here.profile), LENSPROF_ERROR_ARGUMENT);
    here.profile.key.color_temperature_k = 5500.0;
    assert_int_equal(lensprof_profile_validate(&here.profile), LENSPROF_OK);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_first_sizes_stay),        cmocka_unit_test(test_init_writes_the_size_and_no_more),
        cmocka_unit_test(test_sizes_of_older_programs), cmocka_unit_test(test_other_sizes_are_refused),
        cmocka_unit_test(test_elements_have_one_size),  cmocka_unit_test(test_reserved_room_is_empty),
    };
    return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
