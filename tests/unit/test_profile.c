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

enum {
    FIRST = 6,
    CENTER = FIRST + 9,
    ALL = CENTER + 2,
    DRAWS = 40000
};

/* Three responses of two modes, three falloffs off the centre, a gain grid. The covariance is F F', with much larger
 * entries for the coefficients of the responses than for the falloff. */
static lensprof_profile *uncertain_profile(double f[ALL][ALL]) {
    lensprof_profile *p = malloc(sizeof *p);
    uint64_t random = 5;
    lensprof_profile_init(p);
    p->responses = p->vignettings = 3;
    for (int c = 0; c < 3; c++) {
        const double emor[2] = {0.1 * c, -0.05};
        const lensprof_vignetting v = {{-0.3 - 0.1 * c, 0.1, -0.05 * c}, {0.05, -0.03}};
        assert_ok(lensprof_response_set_emor(&p->response[c], emor, 2));
        p->vignetting[c] = v;
    }
    p->grid.columns = p->grid.rows = 2, p->grid.channels = 1;
    for (int i = 0; i < 4; i++) p->grid.attenuation[i] = 0.9f + 0.05f * (float)i;
    for (int i = 0; i < ALL; i++)
        for (int j = 0; j < ALL; j++) f[i][j] = (i < FIRST ? 0.3 : 0.002) * lp_normal(&random);
    p->covariance_size = ALL;
    for (int i = 0; i < ALL; i++)
        for (int j = 0; j < ALL; j++) {
            double sum = 0.0;
            for (int l = 0; l < ALL; l++) sum += f[i][l] * f[j][l];
            p->covariance[i * ALL + j] = sum;
        }
    assert_ok(lensprof_profile_validate(p));
    return p;
}

static double polynomial(const double *k, double r2) { return 1.0 + k[0] * r2 + k[1] * r2 * r2 + k[2] * r2 * r2 * r2; }

/* Red M at (10, 70) of 400 x 300 pixels (half diagonal 250), in the corner and at r = 0.5. */
static void measure(const double *k, const double *center, double m[3]) {
    const double x = (10.0 - 199.5) / 250.0 - center[0], y = (70.0 - 149.5) / 250.0 - center[1];
    m[0] = polynomial(k, x * x + y * y), m[1] = polynomial(k, 1.0), m[2] = polynomial(k, 0.25);
}

static void test_falloff_errors_are_those_of_draws(void **state) {
    (void)state;
    static double f[ALL][ALL];
    lensprof_profile *p = uncertain_profile(f);
    for (uint32_t c = 0; c < 3; c++) {
        const lensprof_vignetting *v = &p->vignetting[c];
        double expected[3], sum[3] = {0.0}, square[3] = {0.0}, m[3], value[3], sigma[3];
        uint64_t random = 77;
        measure(v->k, v->center, expected);
        for (int draw = 0; draw < DRAWS; draw++) {
            double z[ALL], k[3], center[2];
            for (int i = 0; i < ALL; i++) z[i] = lp_normal(&random);
            for (int i = 0; i < 5; i++) {
                const uint32_t row = i < 3 ? FIRST + 3 * c + (uint32_t)i : CENTER + (uint32_t)i - 3;
                double *drawn = i < 3 ? &k[i] : &center[i - 3];
                *drawn = i < 3 ? v->k[i] : v->center[i - 3];
                for (int j = 0; j < ALL; j++) *drawn += f[row][j] * z[j];
            }
            measure(k, center, m);
            for (int i = 0; i < 3; i++) sum[i] += m[i] - expected[i], square[i] += pow(m[i] - expected[i], 2);
        }
        const double grid = lensprof_gain_grid_eval(&p->grid, 400, 300, 10, 70, c);
        value[0] = lensprof_profile_falloff(p, c, 400, 300, 10, 70, &sigma[0]);
        value[1] = lensprof_profile_corner_falloff(p, c, &sigma[1]);
        value[2] = lensprof_profile_radial_falloff(p, c, 0.5, &sigma[2]);
        for (int i = 0; i < 3; i++) {
            const double factor = i ? 1.0 : grid;
            const double drawn = sqrt(square[i] / DRAWS - pow(sum[i] / DRAWS, 2));
            assert_close(value[i], expected[i] * factor, 1e-14);
            assert_close(sigma[i] / (drawn * factor), 1.0, 0.02);
        }
        assert_true(value[0] == lensprof_profile_falloff(p, c, 400, 300, 10, 70, NULL));
    }
    free(p);
}

static void test_falloff_errors_that_are_not_known(void **state) {
    (void)state;
    static double f[ALL][ALL];
    lensprof_profile *p = uncertain_profile(f), *cut = malloc(sizeof *cut);
    double sigma = 7.0, whole;
    assert_close(lensprof_profile_corner_falloff(p, 3, &sigma), 0.0, 0.0);
    assert_close(sigma, LENSPROF_UNKNOWN, 0.0);
    lensprof_profile_corner_falloff(p, 0, &whole);
    for (uint32_t n = 0; n < ALL; n++) { /* of a covariance that ends early */
        *cut = *p;
        cut->covariance_size = n;
        for (uint32_t i = 0; i < n; i++)
            for (uint32_t j = 0; j < n; j++) cut->covariance[i * n + j] = p->covariance[i * ALL + j];
        lensprof_profile_corner_falloff(cut, 0, &sigma);
        assert_close(sigma, n < FIRST + 3 ? LENSPROF_UNKNOWN : whole, 0.0);
        lensprof_profile_corner_falloff(cut, 2, &sigma);
        assert_true((sigma == LENSPROF_UNKNOWN) == (n < FIRST + 9));
        lensprof_profile_falloff(cut, 2, 400, 300, 10, 70, &sigma);
        assert_true((sigma == LENSPROF_UNKNOWN) == (n < FIRST + 9));
    }
    for (uint32_t i = 0; i < ALL; i++) /* held fixed: the falloff of red, then the centre as well */
        for (uint32_t j = FIRST; j < FIRST + 3; j++) p->covariance[i * ALL + j] = p->covariance[j * ALL + i] = 0.0;
    assert_ok(lensprof_profile_validate(p));
    lensprof_profile_corner_falloff(p, 0, &sigma);
    assert_close(sigma, LENSPROF_UNKNOWN, 0.0);
    lensprof_profile_falloff(p, 0, 400, 300, 10, 70, &sigma);
    assert_true(sigma > 0.0);
    for (uint32_t i = 0; i < ALL; i++)
        for (uint32_t j = CENTER; j < ALL; j++) p->covariance[i * ALL + j] = p->covariance[j * ALL + i] = 0.0;
    lensprof_profile_falloff(p, 0, 400, 300, 10, 70, &sigma);
    assert_close(sigma, LENSPROF_UNKNOWN, 0.0);
    lensprof_profile_corner_falloff(p, 1, &sigma); /* the other channels are unaffected */
    assert_true(sigma > 0.0);
    lensprof_profile_radial_falloff(p, 1, 0.0, &sigma); /* M = 1 in the centre, whatever k */
    assert_close(sigma, 0.0, 0.0);
    free(cut);
    free(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_init_is_valid),
        cmocka_unit_test(test_key_refuses),
        cmocka_unit_test(test_profile_refuses),
        cmocka_unit_test(test_falloff_errors_are_those_of_draws),
        cmocka_unit_test(test_falloff_errors_that_are_not_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
