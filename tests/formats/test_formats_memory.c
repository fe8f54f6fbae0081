/* Every allocation of every call is made to fail once: MEMORY, outputs untouched, nothing leaked (under the address
 * sanitizer). */
#include "pto_support.h"

#include "failing_new.h"

static const char points[] = "0 1 10.5 20 30 40.25 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0\n";

typedef struct world {
    lensprof_pto *pto;
    lensprof_response response;
    lensprof_exposure exposures[4];
    lensprof_profile *profile;
} world;

static lensprof_status read_again(world *w)
{
    (void)w;
    lensprof_pto *untouched = (lensprof_pto *)&untouched, *pto = untouched;
    lensprof_error error;
    lensprof_status status = lensprof_pto_read(SAMPLE_PTO, strlen(SAMPLE_PTO), &pto, &error);
    assert_true((pto == untouched) == (status != LENSPROF_OK));
    if (status == LENSPROF_OK) lensprof_pto_destroy(pto);
    else assert_non_null(strstr(error.text, "out of memory"));
    return status;
}

static lensprof_status read_wrong(world *w)
{
    (void)w;
    const char text[] = "i w10 h10\nv a_name_that_is_far_too_long_for_the_small_string_of_any_library\n";
    lensprof_pto *pto;
    lensprof_status status = lensprof_pto_read(text, strlen(text), &pto, NULL);
    return status == LENSPROF_ERROR_VARIABLE ? LENSPROF_OK : status;
}

static lensprof_status draw(world *w)
{
    uint8_t mask[100 * 60];
    memset(mask, 7, sizeof mask);
    lensprof_status status = lensprof_pto_draw_mask(w->pto, 2, mask, 100, 60, 100);
    for (size_t i = 0; i < sizeof mask; i++) assert_true((mask[i] == 7) == (status != LENSPROF_OK));
    return status;
}

static lensprof_status set_result(world *w)
{
    const lensprof_vignetting vignetting = {{-0.2, 0, 0}, {0, 0}};
    return lensprof_pto_set_result(w->pto, &w->response, &vignetting, w->exposures, 4, 0);
}

static lensprof_status write_points(world *w)
{
    (void)w;
    const lensprof_camera cameras[2] = {{.width = 6, .height = 8}, {.width = 6, .height = 8}};
    const lensprof_pair pair = {{0, 1}, {{1, 2}, {3, 4}}, {{0, 0, 0}, {1, 1, 1}}};
    char text[200] = "untouched";
    lensprof_status status = lensprof_points_write(&pair, 1, cameras, 2, text, sizeof text, NULL);
    assert_true((strcmp(text, "untouched") == 0) == (status != LENSPROF_OK));
    return status;
}

static lensprof_status count_entry(void *user, const lensprof_import_entry *entry)
{
    *(int *)user += (int)entry->usable;
    return LENSPROF_OK;
}

static lensprof_status read_lensfun(world *w)
{
    (void)w;
    const char text[] = "<lensdatabase><camera><maker>A long name of a maker</maker><mount>acme</mount></camera>"
                        "<lens><maker>A long name of a maker</maker><model>and of a lens</model><mount>acme</mount>"
                        "<cropfactor>1</cropfactor><calibration><vignetting model=\"pa\" focal=\"9\" aperture=\"2\" "
                        "distance=\"1\" k1=\"-0.3\"/></calibration></lens></lensdatabase>";
    int entries = 0;
    lensprof_status status = lensprof_lensfun_read(text, sizeof text - 1, "a file", count_entry, &entries, NULL);
    assert_int_equal(entries, status == LENSPROF_OK);
    return status;
}

static lensprof_status write_lensfun(world *w)
{
    const lensprof_profile *const profiles[1] = {w->profile};
    char text[1000] = "untouched";
    size_t needed = 0;
    lensprof_status status = lensprof_lensfun_write(profiles, 1, text, sizeof text, &needed, NULL);
    assert_true((strcmp(text, "untouched") == 0) == (status != LENSPROF_OK));
    return status;
}

static lensprof_status read_points(world *w)
{
    (void)w;
    lensprof_pair pair;
    uint32_t found;
    return lensprof_points_read(points, strlen(points), &pair, 1, &found, NULL);
}

static void fail_each(world *w, lensprof_status (*call)(world *), long at_least)
{
    long good = 0;
    lensprof_status status;
    do {
        char *before = write_pto(w->pto);
        lp_fail_allocation_after(good++);
        status = call(w);
        lp_fail_allocation_after(-1);
        char *after = write_pto(w->pto);
        if (status != LENSPROF_OK) {
            assert_int_equal(status, LENSPROF_ERROR_MEMORY);
            assert_string_equal(after, before);
        }
        free(before);
        free(after);
    } while (status != LENSPROF_OK && good < 10000);
    assert_ok(status);
    assert_true(good > at_least);
}

static void test_out_of_memory(void **state)
{
    (void)state;
    world *w = calloc(1, sizeof *w);
    w->pto = read_pto(SAMPLE_PTO);
    w->profile = malloc(sizeof *w->profile);
    lensprof_profile_init(w->profile);
    strcpy(w->profile->key.lens, "A lens with a long name");
    w->profile->key.crop_factor = w->profile->key.focal_mm = w->profile->key.aperture = 2;
    lensprof_response_set_linear(&w->response);
    for (int i = 0; i < 4; i++) lensprof_exposure_init(&w->exposures[i]);
    fail_each(w, read_again, 10);
    fail_each(w, read_wrong, 3);
    fail_each(w, draw, 2);
    fail_each(w, set_result, 20);
    fail_each(w, write_points, 1);
    fail_each(w, read_lensfun, 5);
    fail_each(w, write_lensfun, 5);
    fail_each(w, read_points, 0); /* needs no memory at all */
    lensprof_pto_destroy(w->pto);
    free(w->profile);
    free(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
