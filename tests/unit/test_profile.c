/* Profiles as values. */
#include "support.h"

#include <lensprof/profile.h>

static void test_init_is_valid(void **state) {
    (void)state;
    lensprof_profile *p = malloc(sizeof *p);
    lensprof_profile_init(p);
    assert_ok(lensprof_profile_validate(p));
    assert_close(p->key.focal_mm, LENSPROF_UNKNOWN, 0.0);
    assert_int_equal(p->key.processing, LENSPROF_PROCESSING_JPEG);
    free(p);
}

static void test_key_refuses(void **state) {
    (void)state;
    lensprof_profile_key good, k;
    lensprof_profile_key_init(&good);
    k = good, memset(k.lens, 'x', sizeof k.lens); /* not terminated */
    assert_int_equal(lensprof_profile_key_validate(&k), LENSPROF_ERROR_ARGUMENT);
    k = good, strcpy(k.camera_model, "a\nb");
    assert_int_equal(lensprof_profile_key_validate(&k), LENSPROF_ERROR_ARGUMENT);
    k = good, k.focal_mm = 0.0;
    assert_int_equal(lensprof_profile_key_validate(&k), LENSPROF_ERROR_ARGUMENT);
    k = good, k.aperture = NAN;
    assert_int_equal(lensprof_profile_key_validate(&k), LENSPROF_ERROR_ARGUMENT);
    k = good, k.aperture = INFINITY;
    assert_int_equal(lensprof_profile_key_validate(&k), LENSPROF_ERROR_ARGUMENT);
    k = good, k.processing = 3;
    assert_int_equal(lensprof_profile_key_validate(&k), LENSPROF_ERROR_ARGUMENT);
    k = good, k.distance_m = INFINITY; /* a focus distance */
    assert_ok(lensprof_profile_key_validate(&k));
}

static void test_profile_refuses(void **state) {
    (void)state;
    lensprof_profile *p = malloc(sizeof *p);
    lensprof_profile_init(p);
    p->responses = 2;
    assert_int_equal(lensprof_profile_validate(p), LENSPROF_ERROR_ARGUMENT);
    lensprof_profile_init(p);
    p->response[0].table[10] = 2.0;
    assert_int_equal(lensprof_profile_validate(p), LENSPROF_ERROR_RESPONSE);
    lensprof_profile_init(p);
    p->vignettings = 3;
    p->vignetting[2].k[0] = -1.5;
    assert_int_equal(lensprof_profile_validate(p), LENSPROF_ERROR_VIGNETTING);
    lensprof_profile_init(p);
    p->grid.columns = p->grid.rows = 2, p->grid.channels = 1; /* all attenuations 0 */
    assert_int_equal(lensprof_profile_validate(p), LENSPROF_ERROR_VIGNETTING);
    for (int i = 0; i < 4; i++) p->grid.attenuation[i] = 0.5f;
    assert_ok(lensprof_profile_validate(p));
    p->grid.rows = 1;
    assert_int_equal(lensprof_profile_validate(p), LENSPROF_ERROR_SIZE);
    lensprof_profile_init(p);
    p->covariance_size = LENSPROF_COVARIANCE_MAX + 1;
    assert_int_equal(lensprof_profile_validate(p), LENSPROF_ERROR_SIZE);
    p->covariance_size = 2;
    p->covariance[1] = 0.5; /* not symmetric */
    assert_int_equal(lensprof_profile_validate(p), LENSPROF_ERROR_ARGUMENT);
    p->covariance[2] = 0.5;
    assert_ok(lensprof_profile_validate(p));
    p->covariance[0] = -1.0;
    assert_int_equal(lensprof_profile_validate(p), LENSPROF_ERROR_ARGUMENT);
    p->covariance[0] = NAN;
    assert_int_not_equal(lensprof_profile_validate(p), LENSPROF_OK);
    free(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_init_is_valid),
        cmocka_unit_test(test_key_refuses),
        cmocka_unit_test(test_profile_refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
