/* A lookup composes the falloff of the lens and the response of the camera, each from the profiles that know it. */
#include "lookup_fixture.h"

#define LENS "Example 50mm f/2"
#define RAW LENSPROF_PROCESSING_RAW
#define JPEG LENSPROF_PROCESSING_JPEG
#define CORRECTED LENSPROF_PROCESSING_CORRECTED

static lensprof_profile *profile_of(const char *camera, const char *lens, uint32_t processing, double aperture) {
    lensprof_profile *p = zoom_profile(lens, 50, aperture, INFINITY);
    snprintf(p->key.camera_model, sizeof p->key.camera_model, "%s", camera);
    p->key.processing = processing;
    p->vignetting[0].k[0] = -0.8 / aperture;
    return p;
}

static void put_raw(lensprof_store *store) {
    for (int a = 0; a < 3; a++) put_at(store, profile_of("", LENS, RAW, 2 << a));
}

/* A rendered profile of a camera with a gamma response; sigma 0: it states no error. */
static int64_t put_rendered(lensprof_store *store, const char *camera, double gamma, double sigma, const char *style) {
    lensprof_profile *p = profile_of(camera, "Example 85mm f/2", JPEG, 2.0);
    snprintf(p->key.style, sizeof p->key.style, "%s", style);
    assert_ok(lensprof_response_set_gamma(&p->response[0], gamma));
    p->provenance.gamma_sigma = sigma;
    return put_at(store, p);
}

static lensprof_profile_key key_of(const char *camera, uint32_t processing, double aperture) {
    return profile_of(camera, LENS, processing, aperture)->key;
}

static lensprof_status ask_for(lensprof_store *store, const lensprof_profile_key *key) {
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    return ask_with(store, key, &options);
}

static double eval(double x) { return lensprof_response_eval(&answered.response[0], x, NULL); }

/* Falloffs of raw pictures apply to rendered ones; without a response of the camera, that of its kind is used. */
static void test_raw_rows_serve_jpeg(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    lensprof_response typical;
    double covariance[LENSPROF_EMOR_MODES * LENSPROF_EMOR_MODES], sigma;
    put_raw(store);
    const struct {
        const char *camera;
        uint32_t kind;
    } cases[] = {{"EOS 5D", LENSPROF_CAMERA_STILL}, {"iPhone 12", LENSPROF_CAMERA_PHONE}, {"", LENSPROF_CAMERA_ANY}};
    for (int i = 0; i < 3; i++) {
        const lensprof_profile_key key = key_of(cases[i].camera, JPEG, 2.0);
        assert_ok(lensprof_response_set_typical(&typical, cases[i].kind, covariance, &sigma));
        assert_ok(ask_for(store, &key));
        assert_int_equal(how.exact, 0);
        assert_int_equal(how.response_from, LENSPROF_RESPONSE_FROM_KIND);
        assert_int_equal(how.camera_kind, cases[i].kind);
        assert_int_equal(how.response_rows, 0);
        assert_close(how.response_sigma, sigma, 0.0);
        assert_memory_equal(answered.response[0].table, typical.table, sizeof typical.table);
        assert_close(answered.vignetting[0].k[0], -0.4, 1e-3);
        assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_TYPICAL_RESPONSE, "typical"));
        const double m = 0.6, by_response = -m * log(m) * sigma;
        assert_close(how.sigma, sqrt(how.falloff_sigma * how.falloff_sigma + by_response * by_response), 1e-3);
        assert_int_equal(answered.covariance_size, LENSPROF_EMOR_MODES + 3);
        assert_close(answered.covariance[0], covariance[0], 0.0);
        assert_close(answered.provenance.gamma_sigma, sigma, 0.0);
        lensprof_profile_corner_falloff(&answered, 0, &sigma);
        assert_close(sigma, how.falloff_sigma, 1e-9);
        assert_ok(lensprof_profile_validate(&answered));
    }
    lensprof_store_close(store);
}

static void test_raw_is_linear(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    put_raw(store);
    put_rendered(store, "EOS 5D", 2.2, 0.02, "");
    lensprof_profile_key key = key_of("EOS 5D", RAW, 2.8);
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.response_from, LENSPROF_RESPONSE_FROM_RAW);
    assert_int_equal(answered.response[0].kind, LENSPROF_RESPONSE_LINEAR);
    assert_close(how.response_sigma, 0.0, 0.0);
    assert_close(how.sigma, how.falloff_sigma, 1e-12);
    key.aperture = 2.0; /* stored for any camera */
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.exact, 1);
    assert_int_equal(how.response_from, LENSPROF_RESPONSE_FROM_PROFILE);
    lensprof_store_close(store);
}

/* Responses of this camera only, with any lens and any spelling of its name; their mean, weighted by their errors. */
static void test_responses_of_the_camera(void **state) {
    static const char *const names[] = {"EOS 600D", "Canon EOS 600D", "canon eos REBEL T3i", "EOS Kiss X5"};
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    put_raw(store);
    put_rendered(store, "EOS 5D", 3.0, 0.01, "");
    const int64_t first = put_rendered(store, "Canon EOS 600D", 2.0, 0.02, "");
    for (int i = 0; i < 4; i++) {
        lensprof_profile_key key = key_of(names[i], JPEG, 2.0);
        snprintf(key.camera_maker, sizeof key.camera_maker, "Canon");
        assert_ok(ask_for(store, &key));
        assert_int_equal(how.response_from, LENSPROF_RESPONSE_FROM_CAMERA);
        assert_int_equal(how.response_rows, 1);
        assert_int_equal(how.response_id[0], first);
        assert_close(how.response_weight[0], 1.0, 0.0);
        assert_close(eval(0.25), 0.5, 1e-4);
        assert_close(how.response_sigma, hypot(0.02, 0.018), 1e-12);
    }
    const int64_t second = put_rendered(store, "EOS 600D", 2.4, 0.01, "");
    const lensprof_profile_key key = key_of("Canon EOS 600D", JPEG, 2.0);
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.response_rows, 2);
    for (uint32_t i = 0; i < 2; i++)
        assert_close(how.response_weight[i], how.response_id[i] == second ? 0.8 : 0.2, 1e-12);
    assert_close(eval(0.25), 0.2 * 0.5 + 0.8 * pow(0.25, 1.0 / 2.4), 1e-3);
    assert_close(how.response_sigma, hypot(sqrt(0.2 * 0.2 * 0.02 * 0.02 + 0.8 * 0.8 * 0.01 * 0.01), 0.018), 1e-9);
    lensprof_store_close(store);
}

/* A bracket is stored without lens and setting and has no falloff, so the falloff of the camera's lens is used. */
static void test_bracket_has_no_falloff(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    lensprof_profile *p = profile_of("DSC-RX100", "Fixed 10-37mm", RAW, 2.0);
    p->vignetting[0].k[0] = -0.4;
    put_at(store, p);
    p = profile_of("DSC-RX100", "", JPEG, LENSPROF_UNKNOWN);
    p->key.focal_mm = LENSPROF_UNKNOWN;
    memset(p->vignetting[0].k, 0, sizeof p->vignetting[0].k);
    assert_ok(lensprof_response_set_gamma(&p->response[0], 2.0));
    p->provenance.gamma_sigma = 0.02;
    const lensprof_profile_key bracket = p->key;
    const int64_t id = put_at(store, p);
    lensprof_profile_key key = key_of("DSC-RX100", JPEG, 2.0);
    key.lens[0] = 0;
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.exact, 0);
    assert_close(answered.vignetting[0].k[0], -0.4, 1e-9);
    assert_int_equal(how.response_from, LENSPROF_RESPONSE_FROM_CAMERA);
    assert_int_equal(how.response_id[0], id);
    assert_ok(ask_for(store, &bracket)); /* a query with its own key finds it exactly */
    assert_int_equal(how.exact, 1);
    assert_int_equal(how.id[0], id);
    lensprof_store_close(store);
}

/* Errors of a prior on the kind of camera are common to all profiles: averaging does not reduce them. */
static void test_shared_errors_stay(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    put_raw(store);
    for (int i = 0; i < 12; i++) put_rendered(store, "EOS 5D", 2.2, 0.07, "");
    const lensprof_profile_key key = key_of("EOS 5D", JPEG, 2.0);
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.response_rows, LENSPROF_LOOKUP_RESPONSES);
    assert_close(how.response_sigma, hypot(0.07, 0.018), 1e-9);
    assert_close(eval(0.25), pow(0.25, 1.0 / 2.2), 1e-3);
    lensprof_store_close(store);
}

/* If there are more profiles than are used, the newest count, under any of the camera's names. */
static void test_newest_under_all_names(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    int64_t newest = 0;
    put_raw(store);
    for (int i = 0; i < 2 * LENSPROF_LOOKUP_RESPONSES; i++)
        newest = put_rendered(store, i % 2 ? "Canon EOS 5D" : "EOS 5D", 2.2, 0.07, "");
    lensprof_profile_key key = key_of("EOS 5D", JPEG, 2.0);
    strcpy(key.camera_maker, "Canon");
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.response_rows, LENSPROF_LOOKUP_RESPONSES);
    for (int i = 0; i < LENSPROF_LOOKUP_RESPONSES; i++) assert_int_equal(how.response_id[i], newest - i);
    lensprof_store_close(store);
}

/* Numeric derivative of q = ln ln(I(208) / I(48)) by EMoR coefficient l. */
static double gamma_slope(const lensprof_response *response, uint32_t l) {
    const double h = 1e-4;
    double q[2];
    for (int side = 0; side < 2; side++) {
        double coefficients[LENSPROF_EMOR_MODES];
        lensprof_response moved;
        memcpy(coefficients, response->emor, sizeof coefficients);
        coefficients[l] += side ? h : -h;
        assert_ok(lensprof_response_set_emor(&moved, coefficients, response->modes));
        q[side] = log(log(lensprof_response_invert(&moved, 208.0 / 255.0, NULL)
                          / lensprof_response_invert(&moved, 48.0 / 255.0, NULL)));
    }
    return (q[1] - q[0]) / (2.0 * h);
}

/* The covariance has the variance of gamma that response_sigma states, and otherwise that of the profiles. */
static void check_covariance_of_response(double variance, double tolerance) {
    double slope[3], along = 0.0;
    for (uint32_t i = 0; i < 3; i++) slope[i] = gamma_slope(&answered.response[0], i);
    for (uint32_t i = 0; i < 3; i++)
        for (uint32_t j = 0; j < 3; j++) along += slope[i] * slope[j] * answered.covariance[6 * i + j];
    assert_close(along / (how.response_sigma * how.response_sigma), 1.0, 1e-3);
    const double x = slope[1], y = -slope[0], *c = answered.covariance; /* across the slope */
    assert_close((x * x * c[0] + x * y * (c[1] + c[6]) + y * y * c[7]) / (x * x + y * y), variance, tolerance);
}

static void test_covariances_of_responses(void **state) {
    static const double coefficients[2][3] = {{0.5, 0.1, 0.02}, {0.7, 0.1, 0.0}};
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    double first = 0.0;
    put_raw(store);
    for (int i = 0; i < 2; i++) {
        lensprof_profile *p = profile_of("EOS 5D", "Example 85mm f/2", JPEG, 2.0);
        assert_ok(lensprof_response_set_emor(&p->response[0], coefficients[i], 3));
        p->covariance_size = 6;
        for (uint32_t j = 0; j < 6; j++) p->covariance[7 * j] = 4e-4;
        put_at(store, p);
        const lensprof_profile_key key = key_of("EOS 5D", JPEG, 2.0);
        assert_ok(ask_for(store, &key));
        assert_int_equal(answered.covariance_size, 6);
        assert_int_equal(answered.response[0].kind, LENSPROF_RESPONSE_EMOR);
        assert_close(answered.response[0].emor[0], i ? 0.6 : 0.5, 0.02);
        const double own = how.response_sigma * how.response_sigma - 0.018 * 0.018; /* apart from the repeatability */
        if (!i) first = own;
        check_covariance_of_response(i ? 2e-4 : 4e-4, i ? 2e-5 : 1e-7);
        assert_true(own > (i ? 0.4 : 0.99) * first && own < (i ? 0.7 : 1.01) * first && first > 1e-5);
        double sigma;
        lensprof_profile_corner_falloff(&answered, 0, &sigma);
        assert_close(sigma, how.falloff_sigma, 1e-9);
    }
    lensprof_store_close(store);
}

/* A picture style's own responses take precedence over those without a style; those of other styles are not used. */
static void test_styles(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    put_raw(store);
    const int64_t vivid = put_rendered(store, "EOS 5D", 3.0, 0.02, "Vivid");
    lensprof_profile_key key = key_of("EOS 5D", JPEG, 2.0);
    strcpy(key.style, "Neutral");
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.response_from, LENSPROF_RESPONSE_FROM_KIND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_OTHER_STYLE, "other picture styles"));
    const int64_t plain = put_rendered(store, "EOS 5D", 2.2, 0.02, "");
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.response_rows, 1);
    assert_int_equal(how.response_id[0], plain);
    assert_int_equal(how.reason_code[0], LENSPROF_REASON_NONE);
    strcpy(key.style, "VIVID");
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.response_rows, 1);
    assert_int_equal(how.response_id[0], vivid);
    *key.style = 0;
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.response_rows, 2);
    lensprof_store_close(store);
}

/* Not used: linear responses of rendered pictures, which importers write if they know none; forced and doubtful
 * profiles; and profiles that a newer one includes. */
static void test_which_responses(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    put_raw(store);
    put_at(store, profile_of("EOS 5D", "Example 85mm f/2", JPEG, 2.0));
    lensprof_profile_key key = key_of("EOS 5D", JPEG, 2.0);
    for (int i = 0; i < 2; i++) {
        lensprof_profile *p = profile_of("EOS 5D", "Example 85mm f/2", JPEG, 2.0);
        assert_ok(lensprof_response_set_gamma(&p->response[0], 2.0));
        p->provenance.forced = i == 0;
        strcpy(p->provenance.doubt, i == 1 ? "odd" : "");
        put_at(store, p);
        assert_ok(ask_for(store, &key));
        assert_int_equal(how.response_from, LENSPROF_RESPONSE_FROM_KIND);
    }
    put_rendered(store, "EOS 5D", 2.2, 0.26, ""); /* less accurate than the typical response */
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.response_from, LENSPROF_RESPONSE_FROM_KIND);
    const int64_t old = put_rendered(store, "EOS 5D", 2.2, 0.02, "");
    lensprof_profile *p = profile_of("EOS 5D", "Example 85mm f/2", JPEG, 2.0);
    assert_ok(lensprof_response_set_gamma(&p->response[0], 2.3));
    p->provenance.prior_id = old;
    const int64_t new = put_at(store, p);
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.response_rows, 1);
    assert_int_equal(how.response_id[0], new);
    p->provenance.prior_id = new; /* which includes the oldest, too */
    const int64_t newest = put_at(store, p);
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.response_rows, 1);
    assert_int_equal(how.response_id[0], newest);
    const lensprof_profile_key nameless = key_of("-", JPEG, 2.0);
    assert_ok(ask_for(store, &nameless));
    assert_int_equal(how.response_from, LENSPROF_RESPONSE_FROM_KIND);
    lensprof_store_close(store);
}

/* Pictures that the camera has corrected are not corrected again, unless forced. */
static void test_corrected(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    put_raw(store);
    put_rendered(store, "EOS 5D", 2.2, 0.02, "");
    const lensprof_profile_key key = key_of("EOS 5D", CORRECTED, 2.0);
    assert_int_equal(ask_with(store, &key, &options), LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_CORRECTED, "the camera corrects"));
    options.force_falloff = 1;
    assert_ok(ask_with(store, &key, &options));
    assert_int_equal(how.response_from, LENSPROF_RESPONSE_FROM_CAMERA); /* the rendering is the same */
    assert_close(answered.vignetting[0].k[0], -0.4, 1e-3);
    options.force_falloff = 0;
    lensprof_profile *p = profile_of("", LENS, CORRECTED, 2.8);
    p->vignetting[0].k[0] = -0.03;
    put_at(store, p);
    p = profile_of("", LENS, CORRECTED, 2.0);
    p->vignetting[0].k[0] = -0.04;
    assert_ok(lensprof_response_set_gamma(&p->response[0], 1.7));
    const int64_t own = put_at(store, p);
    assert_ok(ask_with(store, &key, &options));
    assert_int_equal(how.exact, 1);
    assert_int_equal(how.id[0], own);
    const lensprof_profile_key raw = key_of("EOS 5D", RAW, 2.4); /* they do not apply to other pictures */
    assert_ok(ask_with(store, &raw, &options));
    assert_true(answered.vignetting[0].k[0] < -0.3);
    lensprof_store_close(store);
}

/* If the camera's own profiles are far from the setting, those of the lens alone are used. */
static void test_next_best_profiles(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    put_raw(store);
    lensprof_profile *p = profile_of("EOS 5D", LENS, JPEG, 16.0);
    assert_ok(lensprof_response_set_gamma(&p->response[0], 2.0));
    const int64_t own = put_at(store, p);
    lensprof_profile_key key = key_of("EOS 5D", JPEG, 2.0);
    assert_ok(ask_for(store, &key));
    assert_close(answered.vignetting[0].k[0], -0.4, 1e-3);
    assert_int_equal(how.response_id[0], own);
    key.aperture = 16.0;
    assert_ok(ask_for(store, &key));
    assert_int_equal(how.exact, 1);
    key.aperture = 64.0; /* none is near: the reason is about the camera's own profiles */
    assert_int_equal(ask_for(store, &key), LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_APERTURE_BEYOND, "beyond"));
    lensprof_store_close(store);
}

/* For fits, which estimate the falloff themselves. */
static void test_response_alone(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    options.response_alone = 1;
    const lensprof_profile_key key = key_of("EOS 5D", JPEG, 2.0), raw = key_of("EOS 5D", RAW, 2.0);
    assert_int_equal(ask_with(store, &key, &options), LENSPROF_ERROR_NOT_FOUND);
    lensprof_profile *p = profile_of("EOS 5D", "Example 85mm f/2", JPEG, 2.0);
    static const double coefficients[3] = {0.5, 0.1, 0.02};
    assert_ok(lensprof_response_set_emor(&p->response[0], coefficients, 3));
    p->covariance_size = 6;
    for (uint32_t j = 0; j < 6; j++) p->covariance[7 * j] = 4e-4;
    const int64_t id = put_at(store, p);
    assert_ok(ask_with(store, &key, &options));
    assert_int_equal(how.rows, 0);
    assert_int_equal(how.response_rows, 1);
    assert_int_equal(how.response_id[0], id);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_NO_LENS, "with this name"));
    assert_int_equal(answered.covariance_size, 3);
    assert_close(answered.response[0].emor[0], 0.5, 0.0);
    assert_close(answered.vignetting[0].k[0], 0.0, 0.0);
    assert_true(answered.provenance.gamma_sigma > 0.018);
    assert_ok(lensprof_profile_validate(&answered));
    assert_int_equal(ask_with(store, &raw, &options), LENSPROF_ERROR_NOT_FOUND);
    options.response_alone = 0;
    assert_int_equal(ask_with(store, &key, &options), LENSPROF_ERROR_NOT_FOUND);
    options.response_alone = 2;
    assert_int_equal(ask_with(store, &key, &options), LENSPROF_ERROR_ARGUMENT);
    lensprof_store_close(store);
}

static void test_several_databases(void **state) {
    const place *here = *state;
    char second_path[PATH_MAX];
    lensprof_lookup_options options;
    lensprof_error error;
    lensprof_lookup_options_init(&options);
    snprintf(second_path, sizeof second_path, "%s-2", here->path);
    lensprof_store *first = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_store *second = store_at(second_path, LENSPROF_STORE_CREATE);
    lensprof_store *const both[2] = {first, second}, *const none[2] = {first, NULL};
    const int64_t id = put_rendered(first, "EOS 5D", 2.0, 0.02, "");
    put_raw(second);
    lensprof_profile_key key = key_of("EOS 5D", JPEG, 2.0);
    lensprof_lookup_init(&how);
    assert_ok(lensprof_store_lookup_in(both, 2, &key, &options, &answered, &how, &error));
    assert_int_equal(how.falloff_store, 1);
    assert_int_equal(how.response_store, 0);
    assert_int_equal(how.response_id[0], id);
    assert_close(answered.vignetting[0].k[0], -0.4, 1e-3);
    put_at(first, profile_of("", LENS, RAW, 16.0)); /* knows the lens, but not near this setting */
    assert_ok(lensprof_store_lookup_in(both, 2, &key, &options, &answered, &how, &error));
    assert_int_equal(how.falloff_store, 1);
    lensprof_profile *p = profile_of("", LENS, RAW, 2.0);
    p->vignetting[0].k[0] = -0.2;
    put_at(first, p);
    assert_ok(lensprof_store_lookup_in(both, 2, &key, &options, &answered, &how, &error));
    assert_int_equal(how.falloff_store, 0);
    assert_close(answered.vignetting[0].k[0], -0.2, 1e-3);
    key.focal_mm = 200; /* the reason comes from the database that knows the lens, and the text names its file */
    assert_int_equal(lensprof_store_lookup_in(both, 2, &key, &options, &answered, &how, &error),
                     LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_FOCAL_BEYOND, "beyond"));
    assert_non_null(strstr(error.text, here->path));
    assert_int_equal(lensprof_store_lookup_in(none, 2, &key, &options, &answered, &how, &error),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_lookup_in(both, 0, &key, &options, &answered, &how, &error),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_lookup_in(NULL, 1, &key, &options, &answered, &how, &error),
                     LENSPROF_ERROR_ARGUMENT);
    lensprof_store_close(second);
    lensprof_store_close(first);
    unlink(second_path);
}

/* The stated error includes what is unknown: distance or sensor size. */
static void test_open_settings_widen_the_error(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    static const double distance[3] = {0.3, 1.0, INFINITY}, k[3] = {-0.05, -0.2, -0.6};
    for (int i = 0; i < 3; i++) {
        lensprof_profile *p = zoom_profile("Macro 100mm", 100, 2.8, distance[i]);
        p->vignetting[0].k[0] = k[i];
        put_at(store, p);
    }
    lensprof_profile_key key = zoom_profile("Macro 100mm", 100, 2.8, LENSPROF_UNKNOWN)->key;
    assert_ok(ask_for(store, &key));
    assert_true(how.distance_sigma > 0.05 && how.sensor_sigma == 0.0);
    const double m = 1.0 + answered.vignetting[0].k[0] + answered.vignetting[0].k[1] + answered.vignetting[0].k[2];
    assert_true(m - 2.0 * how.sigma < 0.42 && m > 0.4); /* at infinity M is .4 */
    key.distance_m = INFINITY;
    key.aperture = 3.0;
    key.crop_factor = LENSPROF_UNKNOWN;
    assert_ok(ask_for(store, &key));
    assert_true(how.distance_sigma == 0.0 && how.sensor_sigma > 0.2); /* on a smaller sensor M would be .73 */
    assert_true(how.sigma > how.sensor_sigma);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_UNKNOWN_SENSOR, "unknown"));
    lensprof_store_close(store);
}

/* Between apertures the circle of the nearest profile holds, in half diagonals of the picture's sensor; a smaller one
 * may be covered. */
static void test_image_circles(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    for (int i = 0; i < 3; i++) {
        lensprof_profile *p = zoom_profile("Fisheye 10mm", 10, 2.8 + i, INFINITY);
        p->key.crop_factor = 1.0;
        p->image_circle = (lensprof_image_circle){{0.02, -0.01}, 0.7 + 0.01 * i};
        put_at(store, p);
    }
    lensprof_profile_key key = zoom_profile("Fisheye 10mm", 10, 3.0, INFINITY)->key;
    const double crops[] = {1.0, 1.3, 1.6};
    for (int i = 0; i < 3; i++) {
        key.crop_factor = crops[i];
        assert_ok(ask_for(store, &key));
        const int is_covered = 0.7 * crops[i] - hypot(0.02, 0.01) * crops[i] >= 1.0;
        assert_int_equal(is_covered, i == 2);
        assert_close(answered.image_circle.radius, is_covered ? 0.0 : 0.7 * crops[i], 1e-12);
        assert_close(answered.image_circle.center[0], is_covered ? 0.0 : 0.02 * crops[i], 1e-12);
    }
    lensprof_store_close(store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_raw_rows_serve_jpeg),
        store_test(test_raw_is_linear),
        store_test(test_responses_of_the_camera),
        store_test(test_bracket_has_no_falloff),
        store_test(test_shared_errors_stay),
        store_test(test_newest_under_all_names),
        store_test(test_covariances_of_responses),
        store_test(test_styles),
        store_test(test_which_responses),
        store_test(test_corrected),
        store_test(test_next_best_profiles),
        store_test(test_response_alone),
        store_test(test_several_databases),
        store_test(test_open_settings_widen_the_error),
        store_test(test_image_circles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
