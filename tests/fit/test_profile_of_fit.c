/* Results of fits as profiles: which members come from the result, which stay the caller's, and what is refused. */
#include "support.h"

#include <lensprof/lensprof.h>

static lensprof_profile profile;
static lensprof_fit_options options;
static lensprof_fit_result result;
static lensprof_flat_options card;
static lensprof_flat_result flat;
static lensprof_error error;

/* A caller's profile that still holds another fit's data. */
static int prepare(void **state) {
    (void)state;
    lensprof_profile_init(&profile);
    profile.responses = 3;
    profile.covariance_size = 5;
    for (int i = 0; i < 25; i++) profile.covariance[i] = 9.0;
    profile.grid.columns = profile.grid.rows = 2, profile.grid.channels = 1;
    snprintf(profile.key.lens, sizeof profile.key.lens, "a lens");
    snprintf(profile.provenance.source, sizeof profile.provenance.source, "a file");
    snprintf(profile.provenance.method, sizeof profile.provenance.method, "a method that is longer");
    profile.provenance.created_unix_s = 5, profile.provenance.prior_id = 7, profile.provenance.forced = 1;
    profile.provenance.heldout_rms = 99.0;
    lensprof_fit_options_init(&options);
    lensprof_fit_result_init(&result);
    assert_ok(lensprof_response_set_gamma(&result.response, 2.2));
    result.usable = 1, result.vignettings = 3, result.pairs = 1234;
    result.heldout_rms = 0.5, result.inlier_share = 0.9;
    result.covariance_size = 2;
    lensprof_flat_options_init(&card);
    lensprof_flat_result_init(&flat);
    flat.usable = 1, flat.vignettings = 1, flat.cells = 4321, flat.inlier_share = 0.8;
    flat.gain_grid.columns = flat.gain_grid.rows = 3, flat.gain_grid.channels = 1;
    for (int i = 0; i < 9; i++) flat.gain_grid.attenuation[i] = 0.5f;
    for (int i = 0; i < 4; i++) result.covariance[i] = i == 1 || i == 2 ? 0.25 : 1.0;
    for (int c = 0; c < 3; c++) result.vignetting[c].k[0] = flat.vignetting[c].k[0] = -0.1 * (c + 1);
    return 0;
}

static void assert_kept(void) {
    assert_string_equal(profile.key.lens, "a lens");
    assert_string_equal(profile.provenance.source, "a file");
    assert_int_equal(profile.provenance.created_unix_s, 5);
    assert_int_equal(profile.provenance.prior_id, 7);
    assert_int_equal(profile.provenance.forced, 1);
    assert_string_equal(profile.provenance.software, "lensprof 0.3.0");
    assert_ok(lensprof_profile_validate(&profile));
}

static void test_fit(void **state) {
    prepare(state);
    assert_ok(lensprof_profile_from_fit(&profile, &result, &options, 6, &error));
    assert_kept();
    assert_int_equal(profile.responses, 1);
    assert_memory_equal(&profile.response[0], &result.response, sizeof result.response);
    assert_int_equal(profile.vignettings, 3);
    assert_memory_equal(profile.vignetting, result.vignetting, sizeof result.vignetting);
    assert_int_equal(profile.covariance_size, 2);
    assert_memory_equal(profile.covariance, result.covariance, sizeof profile.covariance); /* nothing of earlier fits */
    assert_int_equal(profile.grid.columns, 0);
    assert_string_equal(profile.provenance.method, "transfer");
    assert_int_equal(profile.provenance.images, 6);
    assert_int_equal(profile.provenance.pairs, 1234);
    assert_close(profile.provenance.heldout_rms, 0.5, 0.0);
    assert_close(profile.provenance.inlier_share, 0.9, 0.0);
    assert_int_equal(profile.provenance.not_usable, 0);
}

static void test_methods_and_verdict(void **state) {
    static const char *const names[] = {"transfer", "radiance", "transfer-function", "debevec"};
    prepare(state);
    for (options.method = 0; options.method < 4; options.method++) {
        assert_ok(lensprof_profile_from_fit(&profile, &result, &options, 6, NULL));
        assert_string_equal(profile.provenance.method, names[options.method]);
    }
    result.usable = 0;
    assert_ok(lensprof_profile_from_fit(&profile, &result, NULL, 6, NULL));
    assert_string_equal(profile.provenance.method, "");
    assert_int_equal(profile.provenance.not_usable, 1);
}

/* The pictures of a prior count if the prior is part of the result, and not otherwise. */
static void test_prior(void **state) {
    static lensprof_profile prior;
    prepare(state);
    lensprof_profile_init(&prior);
    prior.provenance.images = 10, prior.provenance.pairs = UINT32_MAX - 5;
    options.profile = &prior;
    result.profile_prior = LENSPROF_PROFILE_PRIOR_OVERRULED;
    assert_ok(lensprof_profile_from_fit(&profile, &result, &options, 6, &error));
    assert_int_equal(profile.provenance.images, 6);
    assert_int_equal(profile.provenance.pairs, 1234);
    result.profile_prior = LENSPROF_PROFILE_PRIOR_USED;
    assert_ok(lensprof_profile_from_fit(&profile, &result, &options, 6, &error));
    assert_int_equal(profile.provenance.images, 16);
    assert_int_equal(profile.provenance.pairs, UINT32_MAX);           /* saturates instead of overflowing */
    result.profile_prior = LENSPROF_PROFILE_PRIOR_RESPONSE_OVERRULED; /* its falloff is in the result */
    assert_ok(lensprof_profile_from_fit(&profile, &result, &options, 6, &error));
    assert_int_equal(profile.provenance.images, 16);
}

static void test_error_of_gamma(void **state) {
    prepare(state);
    result.gamma_sigma = 0.075;
    assert_ok(lensprof_profile_from_fit(&profile, &result, &options, 6, &error));
    assert_close(profile.provenance.gamma_sigma, 0.075, 0.0);
    result.gamma_sigma = LENSPROF_UNKNOWN;
    assert_ok(lensprof_profile_from_fit(&profile, &result, &options, 6, &error));
    assert_close(profile.provenance.gamma_sigma, 0.0, 0.0); /* unknown */
}

static void test_flat(void **state) {
    static lensprof_response responses[3];
    prepare(state);
    for (int c = 0; c < 3; c++) assert_ok(lensprof_response_set_gamma(&responses[c], 2.0 + c));
    card.response = responses, card.responses = 3;
    assert_ok(lensprof_profile_from_flat(&profile, &flat, &card, 4, &error));
    assert_kept();
    assert_int_equal(profile.responses, 3);
    assert_memory_equal(profile.response, responses, sizeof responses);
    assert_int_equal(profile.vignettings, 1);
    assert_close(profile.vignetting[0].k[0], -0.1, 0.0);
    assert_int_equal(profile.covariance_size, 0);
    assert_memory_equal(&profile.grid, &flat.gain_grid, sizeof profile.grid);
    assert_string_equal(profile.provenance.method, "flat");
    assert_int_equal(profile.provenance.images, 4);
    assert_int_equal(profile.provenance.pairs, 4321);
    assert_close(profile.provenance.heldout_rms, LENSPROF_UNKNOWN, 0.0);
    assert_close(profile.provenance.inlier_share, 0.8, 0.0);
    flat.usable = 0;
    assert_ok(lensprof_profile_from_flat(&profile, &flat, NULL, 4, NULL));
    assert_int_equal(profile.responses, 1);
    assert_int_equal(profile.response[0].kind, LENSPROF_RESPONSE_LINEAR);
    assert_int_equal(profile.provenance.not_usable, 1);
}

static void assert_refused(lensprof_status status, lensprof_status wanted, const char *named) {
    assert_int_equal(status, wanted);
    if (!strstr(error.text, named)) fail_msg("%s", error.text);
    assert_string_equal(profile.provenance.method, "a method that is longer");
}

static void test_refused(void **state) {
    prepare(state);
#define FIT(change) (prepare(state), (change), lensprof_profile_from_fit(&profile, &result, &options, 6, &error))
#define FLAT(change) (prepare(state), (change), lensprof_profile_from_flat(&profile, &flat, &card, 6, &error))
    assert_refused(FIT(result.vignettings = 0), LENSPROF_ERROR_ARGUMENT, "not filled by a fit");
    assert_refused(FIT(result.covariance_size = 37), LENSPROF_ERROR_ARGUMENT, "not filled by a fit");
    assert_refused(FIT(result.struct_size = 0), LENSPROF_ERROR_STRUCT_SIZE, "result");
    assert_refused(FIT(options.struct_size += 8), LENSPROF_ERROR_STRUCT_SIZE, "options");
    assert_refused(FIT(profile.struct_size = 0), LENSPROF_ERROR_STRUCT_SIZE, "profile");
    assert_refused(FLAT(flat.vignettings = 2), LENSPROF_ERROR_ARGUMENT, "not filled by a fit");
    assert_refused(FLAT(card.responses = 2), LENSPROF_ERROR_ARGUMENT, "responses is 2");
    assert_refused(FLAT(card.struct_size = 1), LENSPROF_ERROR_STRUCT_SIZE, "options");
    assert_int_equal(lensprof_profile_from_fit(NULL, &result, &options, 6, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_profile_from_fit(&profile, NULL, &options, 6, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_profile_from_flat(NULL, &flat, &card, 6, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_profile_from_flat(&profile, NULL, &card, 6, NULL), LENSPROF_ERROR_ARGUMENT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fit),   cmocka_unit_test(test_methods_and_verdict),
        cmocka_unit_test(test_prior), cmocka_unit_test(test_error_of_gamma),
        cmocka_unit_test(test_flat),  cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
