/* Typical responses of the kinds of cameras, and the kind derived from a key. */
#include "support.h"

#include <lensprof/profile.h>

enum {
    MODES = LENSPROF_EMOR_MODES
};

/* ln gamma of a curve within its family f(x^(1/gamma)). */
static double position(const lensprof_response *r) {
    return log(log(lensprof_response_invert(r, 208.0 / 255.0, NULL) / lensprof_response_invert(r, 48.0 / 255.0, NULL)));
}

/* Positions measured on the curves themselves (printed by profiles/tools/make_typical_responses.py). */
static void test_typical_curves_stand_where_measured_ones_do(void **state) {
    (void)state;
    const double expected[5] = {0.897, 0.889, 0.822, 0.882, 0.860};
    for (uint32_t kind = 0; kind < LENSPROF_CAMERA_LINEAR; kind++) {
        lensprof_response r;
        assert_ok(lensprof_response_set_typical(&r, kind, NULL, NULL));
        assert_ok(lensprof_response_validate(&r));
        assert_int_equal(r.kind, LENSPROF_RESPONSE_EMOR);
        assert_int_equal(r.modes, MODES);
        assert_close(position(&r), expected[kind], 0.002);
    }
}

/* Current cameras reach mid grey at a sixth to a ninth of white, and render shadows darker than a pure power law. */
static void test_cameras_have_a_tone_curve(void **state) {
    (void)state;
    for (uint32_t kind = LENSPROF_CAMERA_STILL; kind <= LENSPROF_CAMERA_PHONE; kind++) {
        lensprof_response r;
        assert_ok(lensprof_response_set_typical(&r, kind, NULL, NULL));
        double middle = lensprof_response_invert(&r, 128.0 / 255.0, NULL);
        assert_true(middle > 1.0 / 9.0 && middle < 1.0 / 6.0);
        double power = log(128.0 / 255.0) / log(middle);
        assert_true(lensprof_response_eval(&r, 0.01, NULL) < pow(0.01, power));
    }
}

static double pivot(double *matrix, uint32_t k) {
    double p = matrix[k * MODES + k];
    for (uint32_t i = k + 1; i < MODES; i++)
        for (uint32_t j = k + 1; j < MODES; j++)
            matrix[i * MODES + j] -= matrix[i * MODES + k] * matrix[k * MODES + j] / p;
    return p;
}

/* Symmetric and positive definite; the variance of the position equals the stated error of ln gamma. */
static void test_covariance_holds_the_error_of_gamma(void **state) {
    (void)state;
    for (uint32_t kind = 0; kind < LENSPROF_CAMERA_LINEAR; kind++) {
        lensprof_response r, up, down;
        double c[MODES * MODES], sigma, slope[MODES], variance = 0.0;
        assert_ok(lensprof_response_set_typical(&r, kind, c, &sigma));
        for (uint32_t l = 0; l < MODES; l++) {
            double emor[MODES];
            memcpy(emor, r.emor, sizeof emor);
            emor[l] += 1e-4;
            assert_ok(lensprof_response_set_emor(&up, emor, MODES));
            emor[l] -= 2e-4;
            assert_ok(lensprof_response_set_emor(&down, emor, MODES));
            slope[l] = (position(&up) - position(&down)) / 2e-4;
        }
        for (uint32_t i = 0; i < MODES; i++)
            for (uint32_t j = 0; j < MODES; j++) {
                assert_close(c[i * MODES + j], c[j * MODES + i], 0.0);
                variance += slope[i] * slope[j] * c[i * MODES + j];
            }
        assert_close(sqrt(variance) / sigma, 1.0, 0.05);
        for (uint32_t k = 0; k < MODES; k++) assert_true(pivot(c, k) > 0.0);
    }
}

/* The prior for pictures of unknown origin covers the curves that programs use, within two standard errors. */
static void test_any_reaches_plain_curves(void **state) {
    (void)state;
    lensprof_response any, plain;
    double sigma, of_camera;
    assert_ok(lensprof_response_set_typical(&any, LENSPROF_CAMERA_ANY, NULL, &sigma));
    assert_ok(lensprof_response_set_typical(&plain, LENSPROF_CAMERA_STILL, NULL, &of_camera));
    assert_true(sigma > 2.0 * of_camera);
    const double gammas[5] = {1.0, 1.8, 2.0, 2.2, 2.6};
    for (int i = 0; i < 5; i++) {
        assert_ok(lensprof_response_set_gamma(&plain, gammas[i]));
        assert_true(fabs(position(&plain) - position(&any)) <= 2.0 * sigma + 1e-3);
    }
}

static void test_linear_is_exact(void **state) {
    (void)state;
    lensprof_response r;
    double c[MODES * MODES], sigma = 1.0;
    memset(c, 0x7f, sizeof c);
    assert_ok(lensprof_response_set_typical(&r, LENSPROF_CAMERA_LINEAR, c, &sigma));
    assert_int_equal(r.kind, LENSPROF_RESPONSE_LINEAR);
    assert_close(sigma, 0.0, 0.0);
    for (int i = 0; i < MODES * MODES; i++) assert_close(c[i], 0.0, 0.0);
}

static void test_refuses(void **state) {
    (void)state;
    lensprof_response r;
    double sigma = 7.0;
    lensprof_response_set_linear(&r);
    assert_int_equal(lensprof_response_set_typical(NULL, 0, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_response_set_typical(&r, 6, NULL, &sigma), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(r.kind, LENSPROF_RESPONSE_LINEAR);
    assert_close(sigma, 7.0, 0.0);
}

static void assert_kind(const char *maker, const char *model, const char *lens, uint32_t kind) {
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    strcpy(key.camera_maker, maker), strcpy(key.camera_model, model), strcpy(key.lens, lens);
    if (lensprof_camera_kind_of(&key) != kind) print_error("%s, %s, %s\n", maker, model, lens);
    assert_int_equal(lensprof_camera_kind_of(&key), kind);
    key.processing = LENSPROF_PROCESSING_CORRECTED;
    assert_int_equal(lensprof_camera_kind_of(&key), kind);
    key.processing = LENSPROF_PROCESSING_RAW;
    assert_int_equal(lensprof_camera_kind_of(&key), LENSPROF_CAMERA_LINEAR);
}

static void test_phones_by_name(void **state) {
    (void)state;
    const char *const phones[][3] = {{"Apple", "iPhone 12 Pro", "iPhone 12 Pro back triple camera 4.2mm f/1.6"},
                                     {"Google", "Pixel 6", ""},
                                     {"HUAWEI", "VOG-L29", ""},
                                     {"Xiaomi", "2201116SG", ""},
                                     {"OnePlus", "LE2113", ""},
                                     {"OPPO", "CPH2173", ""},
                                     {"vivo", "V2120", ""},
                                     {"HTC", "One_M8", ""},
                                     {"motorola", "moto g(7) plus", ""},
                                     {"LGE", "Nexus 5", ""},
                                     {"LG Electronics", "LG-H870", ""},
                                     {"LG ELECTRONICS", "LG-D855", ""},
                                     {"HMD Global", "Nokia 8", ""},
                                     {"realme", "RMX3085", ""},
                                     {"samsung", "SM-G960U", ""},
                                     {"SAMSUNG", "GT-I9505", ""},
                                     {"samsung", "Galaxy S21 5G", ""},
                                     {"Sony", "G8232", ""},
                                     {"Sony", "XQ-CT72", ""},
                                     {"Sony Ericsson", "LT18i", ""},
                                     {"Sony", "Sony D5803", ""},
                                     {"", "iPhone 4S", ""},
                                     {"", "", "Pixel 4 back camera 4.38mm f/1.73"}};
    for (size_t i = 0; i < sizeof phones / sizeof *phones; i++)
        assert_kind(phones[i][0], phones[i][1], phones[i][2], LENSPROF_CAMERA_PHONE);
}

static void test_cameras_by_name(void **state) {
    (void)state;
    const char *const cameras[][3] = {{"Canon", "Canon EOS 6D", "EF24-70mm f/2.8L USM"},
                                      {"SONY", "ILCE-7M3", ""},
                                      {"SONY", "SLT-A77V", ""},
                                      {"SONY", "DSLR-A900", ""},
                                      {"SONY", "NEX-5N", ""},
                                      {"SONY", "DSC-RX100M3", ""},
                                      {"SONY", "ZV-E10", ""},
                                      {"SONY", "FX30", ""},
                                      {"Sony", "Alpha 7 III", ""},
                                      {"Sony", "A6000", ""},
                                      {"SAMSUNG", "NX300", ""},
                                      {"SAMSUNG", "EK-GC100", ""},
                                      {"SAMSUNG TECHWIN CO., LTD.", "WB650", ""},
                                      {"SAMSUNG", "ST500", ""},
                                      {"NIKON CORPORATION", "NIKON D7000", "24.0-120.0 mm f/4.0"},
                                      {"FUJIFILM", "X100V", ""},
                                      {"Panasonic", "DMC-GF7", ""},
                                      {"OLYMPUS IMAGING CORP.", "E-M5", "OLYMPUS M.45mm F1.8"},
                                      {"DJI", "FC220", ""},
                                      {"Algolux", "A1", ""}, /* lg occurs inside a word */
                                      {"", "Canon EOS 5D", ""}};
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++)
        assert_kind(cameras[i][0], cameras[i][1], cameras[i][2], LENSPROF_CAMERA_STILL);
}

static void test_unnamed_may_be_anything(void **state) {
    (void)state;
    assert_kind("", "", "", LENSPROF_CAMERA_ANY);
    assert_kind("", "", "EF50mm f/1.8", LENSPROF_CAMERA_ANY);
    assert_kind("Nikon", "SUPER COOLSCAN 9000 ED", "", LENSPROF_CAMERA_ANY);
    assert_kind("NORITSU KOKI", "QSS", "", LENSPROF_CAMERA_ANY);
    assert_int_equal(lensprof_camera_kind_of(NULL), LENSPROF_CAMERA_ANY);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_typical_curves_stand_where_measured_ones_do),
        cmocka_unit_test(test_cameras_have_a_tone_curve),
        cmocka_unit_test(test_covariance_holds_the_error_of_gamma),
        cmocka_unit_test(test_any_reaches_plain_curves),
        cmocka_unit_test(test_linear_is_exact),
        cmocka_unit_test(test_refuses),
        cmocka_unit_test(test_phones_by_name),
        cmocka_unit_test(test_cameras_by_name),
        cmocka_unit_test(test_unnamed_may_be_anything),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
