/* What a lookup states about its answer: the standard error, from the covariance of stored profiles, and reasons as
 * text. */
#include "lookup_fixture.h"

#include "falloff/prediction.h"
#include "store/lookup/lookup_choice.h"

static void test_covariance_counts(void **state) {
    (void)state;
    lp_falloff_node nodes[2] = {{1, 50, 2.0, INFINITY, {{-0.2}, {-0.2}, {-0.2}}, 0.0},
                                {2, 50, 2.0, INFINITY, {{-0.4}, {-0.4}, {-0.4}}, 0.0}};
    const lp_falloff_node at = {0, 50, 2.2, INFINITY, {{0}}, 0.0};
    const lp_falloff_nodes known = {nodes, 2, NULL, NULL};
    lp_falloff_prediction equal, unequal;
    assert_int_equal(lp_predict_falloff(&known, &at, &equal), 1);
    nodes[0].variance = 0.1;
    assert_int_equal(lp_predict_falloff(&known, &at, &unequal), 1);
    assert_true(unequal.k[0][0] < equal.k[0][0] - 0.03);
}

/* The same covariance of six coefficients and a falloff, with one response of six modes or three of two. */
static void put_uncertain(lensprof_store *store, uint32_t responses, double aperture, double sigma) {
    static const double none[6] = {0.0};
    lensprof_profile *p = zoom_profile(zoom, 50, aperture, INFINITY);
    true_falloff(50, aperture, p->vignetting[0].k);
    p->responses = responses;
    for (uint32_t c = 0; c < responses; c++)
        assert_ok(lensprof_response_set_emor(&p->response[c], none, 6 / responses));
    p->covariance_size = 11;
    for (uint32_t i = 0; i < 11; i++) p->covariance[12 * i] = i < 6 ? 0.1 : sigma * sigma / 3.0;
    put_at(store, p);
}

static void test_covariance_of_three_responses(void **state) {
    const place *here = *state;
    double k[2][3];
    for (uint32_t i = 0; i < 2; i++) {
        lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
        put_uncertain(store, i ? 3 : 1, 2.0, 0.05);
        put_uncertain(store, i ? 3 : 1, 2.8, 0.0017);
        assert_ok(ask(store, zoom, 50, 2.8, INFINITY));
        double sigma;
        assert_close(how.sigma, 0.0017, 1e-12);
        lensprof_profile_corner_falloff(&answered, 0, &sigma);
        assert_close(sigma, how.sigma, 0.0);
        assert_ok(ask(store, zoom, 50, 2.4, INFINITY)); /* the first one has less weight */
        memcpy(k[i], answered.vignetting[0].k, sizeof k[i]);
        lensprof_store_close(store);
        unlink(here->path);
    }
    assert_memory_equal(k[0], k[1], sizeof k[0]);
}

/* Of three curves the least accurate counts, in answers and in the weights of a prediction. */
static void test_covariance_of_three_curves(void **state) {
    const place *here = *state;
    double k[2];
    for (uint32_t i = 0; i < 2; i++) {
        lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
        for (int row = 0; row < 2; row++) {
            lensprof_profile *p = zoom_profile(zoom, 50, row ? 2.8 : 2.0, INFINITY);
            p->vignettings = 3;
            for (int c = 0; c < 3; c++) true_falloff(50, p->key.aperture, p->vignetting[c].k);
            p->covariance_size = 11;
            const double last = row ? 0.004 : i ? 0.2 : 0.002;
            for (uint32_t n = 0; n < 11; n++) p->covariance[12 * n] = (n / 3 == 2 ? last * last : 1e-6) / 3.0;
            put_at(store, p);
        }
        assert_ok(ask(store, zoom, 50, 2.8, INFINITY));
        assert_int_equal(how.exact, 1);
        assert_close(how.sigma, 0.004, 1e-12);
        assert_ok(ask(store, zoom, 50, 2.4, INFINITY));
        k[i] = answered.vignetting[0].k[0];
        lensprof_store_close(store);
        unlink(here->path);
    }
    assert_true(fabs(k[0] - k[1]) > 1e-4);
}

/* Sentences that do not fit into the text are left out completely; their codes stay. */
static void test_reasons_are_whole(void **state) {
    (void)state;
    static const lensprof_reason codes[] = {
        LENSPROF_REASON_LOOKUP_OTHER_LIGHT,      LENSPROF_REASON_LOOKUP_SMALLEST_SENSOR,
        LENSPROF_REASON_LOOKUP_BY_WORDS,         LENSPROF_REASON_LOOKUP_FOCAL_ROUNDED,
        LENSPROF_REASON_LOOKUP_APERTURE_OUTSIDE, LENSPROF_REASON_LOOKUP_WEAKEST_DISTANCE};
    enum {
        COUNT = sizeof codes / sizeof *codes
    };
    char lens[128], expected[1000];
    for (size_t length = 0; length < sizeof lens; length++) {
        lensprof_lookup lookup;
        lensprof_lookup_init(&lookup);
        memset(lens, 'x', length), lens[length] = '\0';
        expected[0] = '\0';
        for (uint32_t i = 0; i < COUNT; i++) {
            const char *name = codes[i] == LENSPROF_REASON_LOOKUP_BY_WORDS ? lens : NULL;
            lp_add_lookup_reason(&lookup, codes[i], name);
            assert_int_equal(lookup.reason_code[i], codes[i]);
            const char *tails[] = {name, NULL};
            for (int t = name ? 0 : 1; t < 2; t++) {
                char longer[sizeof expected];
                snprintf(longer, sizeof longer, "%s%s%s%s%s", expected, *expected ? "; " : "",
                         lensprof_reason_text(codes[i]), tails[t] ? ": " : "", tails[t] ? tails[t] : "");
                if (strlen(longer) >= sizeof lookup.reason) continue;
                memcpy(expected, longer, sizeof expected);
                break;
            }
        }
        assert_string_equal(lookup.reason, expected);
        assert_true(strlen(expected) > 150);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_covariance_counts),
        store_test(test_covariance_of_three_responses),
        store_test(test_covariance_of_three_curves),
        store_test(test_reasons_are_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
