/* Writing Hugin projects: nothing changes except what was set, and set values read back. */
#include <math.h>

#include "pto_support.h"

#include <lensprof/model.h>

static void test_unmodified_is_identical(void **state) {
    (void)state;
    const char *const texts[] = {SAMPLE_PTO, "i w10 h10",
                                 "\r\n\t# x\r\ni w10 h10  n\"a b\" \r\nv\r\n\n\n*\n garbage \xff\n"};
    for (size_t i = 0; i < 3; i++) {
        lensprof_pto *pto = read_pto(texts[i]);
        char *text = write_pto(pto);
        assert_string_equal(text, texts[i]);
        free(text);
        lensprof_pto_destroy(pto);
    }
}

static void test_write_into_buffers(void **state) {
    (void)state;
    const char *text = "i w10 h10\n";
    lensprof_pto *pto = read_pto(text);
    char buffer[16] = "untouched";
    size_t needed = 0;
    assert_int_equal(lensprof_pto_write(pto, buffer, 9, &needed, NULL), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(needed, 10);
    assert_string_equal(buffer, "untouched");
    buffer[10] = 'x';
    assert_ok(lensprof_pto_write(pto, buffer, 10, NULL, NULL)); /* exactly the bytes */
    assert_memory_equal(buffer, "i w10 h10\nx", 11);
    assert_ok(lensprof_pto_write(pto, buffer, 11, NULL, NULL)); /* room for a terminator */
    assert_string_equal(buffer, text);
    assert_int_equal(lensprof_pto_write(NULL, buffer, 11, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_write(pto, NULL, 11, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
    lensprof_pto_destroy(pto);
}

static const double emor[5] = {0.71, -0.123456789012345, 0.05, 1e-7, -0.02};
static const lensprof_vignetting falloff = {{-0.31, 0.0625, -0.011}, {0.04, -0.07}};

/* Images 1 and 2 of the sample share Eev, images 0 to 2 share Er. Exposures are relative to image 3. */
static void make_exposures(lensprof_exposure exposures[4]) {
    const double ev[4] = {0.75, -0.5, -0.5, 0.25}, red[4] = {1.5, 1.5, 1.5, 1}, blue[4] = {0.5, 0.8, 0.8, 1};
    for (int i = 0; i < 4; i++) exposures[i] = (lensprof_exposure){ev[i], {red[i], 1, blue[i]}};
}

static lensprof_pto *sample_with_result(void) {
    lensprof_pto *pto = read_pto(SAMPLE_PTO);
    lensprof_response *response = malloc(sizeof *response);
    lensprof_exposure exposures[4];
    make_exposures(exposures);
    assert_ok(lensprof_response_set_emor(response, emor, 5));
    assert_ok(lensprof_pto_set_result(pto, response, &falloff, exposures, 4, 3, NULL));
    free(response);
    return pto;
}

static void assert_result(const lensprof_pto *pto) {
    lensprof_exposure exposures[4];
    make_exposures(exposures);
    for (uint32_t i = 0; i < 4; i++) {
        lensprof_pto_image image = image_of(pto, i);
        assert_memory_equal(image.emor, emor, sizeof emor);
        assert_memory_equal(image.vignetting.k, falloff.k, sizeof falloff.k);
        if (i != 2) { /* the centre is linked, in pixels, to that of a frame of another size */
            assert_close(image.vignetting.center[0], falloff.center[0], 1e-15);
            assert_close(image.vignetting.center[1], falloff.center[1], 1e-15);
        }
        assert_close(image.exposure.ev, exposures[i].ev - exposures[3].ev, 1e-15); /* image 3 has Eev0 */
        assert_close(image.exposure.white_balance[0], exposures[i].white_balance[0], 1e-15);
        assert_close(image.exposure.white_balance[2], exposures[i].white_balance[2], 1e-15);
    }
}

static void test_result_reads_back(void **state) {
    (void)state;
    lensprof_pto *pto = sample_with_result();
    assert_result(pto);
    char *text = write_pto(pto);
    lensprof_pto *again = read_pto(text);
    assert_result(again);
    lensprof_pto_destroy(again);
    free(text);
    lensprof_pto_destroy(pto);
}

static void test_only_the_result_changes(void **state) {
    (void)state;
    lensprof_pto *pto = sample_with_result();
    char *text = write_pto(pto), *copy = text;
    const char *old = SAMPLE_PTO;
    while (*old) { /* all other lines are unchanged */
        size_t length = strcspn(old, "\n") + 1, new_length = strcspn(copy, "\n") + 1;
        if (strncmp(old, "i ", 2) != 0) {
            assert_int_equal(new_length, length);
            assert_memory_equal(copy, old, length);
        }
        old += length;
        copy += new_length;
    }
    assert_string_equal(copy, "");
    const char *const kept[] = {"w", "h", "f", "v", "r", "p", "y", "TrX", "Tpp", "j", "a", "d", "g", "S", "C", "n\""};
    for (size_t i = 0; i < sizeof kept / sizeof kept[0]; i++) {
        for (int image = 0; image < 4; image++) {
            const char *before = item_of(SAMPLE_PTO, image, kept[i]);
            char expected[64] = "";
            if (before) strcpy(expected, before);
            const char *after = item_of(text, image, kept[i]);
            assert_true(!before == !after);
            if (after) assert_string_equal(after, expected);
        }
    }
    free(text);
    lensprof_pto_destroy(pto);
}

static void test_links_stay_and_missing_items_come(void **state) {
    (void)state;
    lensprof_pto *pto = sample_with_result();
    char *text = write_pto(pto);
    assert_string_equal(item_of(text, 1, "Ra"), "=0");
    assert_string_equal(item_of(text, 2, "Ra"), "=1");
    assert_string_equal(item_of(text, 2, "Eev"), "=1");
    assert_string_equal(item_of(text, 1, "Eev"), "0.75");
    assert_string_equal(item_of(text, 1, "Vx"), "=0");
    assert_string_equal(item_of(text, 0, "Ra"), "0.71");
    assert_string_equal(item_of(text, 0, "Rd"), "1e-07");
    assert_string_equal(item_of(text, 3, "Ra"), "0.71");
    assert_string_equal(item_of(text, 3, "Eev"), "0");
    assert_string_equal(item_of(text, 3, "Vm"), "5");
    assert_string_equal(item_of(text, 3, "Va"), "1");
    assert_null(item_of(text, 3, "Rt"));
    free(text);
    lensprof_pto_destroy(pto);
}

/* The reference keeps every bit of its exposure and white balance, whatever the values. */
static void test_reference_stays(void **state) {
    (void)state;
    lensprof_response *response = malloc(sizeof *response);
    assert_ok(lensprof_response_set_emor(response, emor, 5));
    const lensprof_exposure exposures[2] = {{3, {1.3, 1, 0.7}}, {2, {1.3, 1, 0.35}}};
    lensprof_pto *pto = read_pto("i w10 h10 Eev7.123456 Er1.1 Eb0.9\r\ni w10 h10 Eev1 Er1 Eb1 Rt1 Vm0\r\n");
    assert_ok(lensprof_pto_set_result(pto, response, &falloff, exposures, 2, 0, NULL));
    lensprof_pto_image image = image_of(pto, 0);
    assert_true(image.exposure.ev == -7.123456);
    assert_true(image.exposure.white_balance[0] == 1.1 && image.exposure.white_balance[2] == 0.9);
    image = image_of(pto, 1);
    assert_close(image.exposure.ev, -8.123456, 1e-14); /* one step less light */
    assert_close(image.exposure.white_balance[0], 1.1, 1e-15);
    assert_close(image.exposure.white_balance[2], 0.45, 1e-15);
    assert_int_equal(image.response_type, 0);
    char *text = write_pto(pto);
    assert_string_equal(item_of(text, 1, "Rt"), "0");
    assert_string_equal(item_of(text, 1, "Vm"), "5");
    assert_null(strstr(text, "\n\n"));
    assert_int_equal(text[strlen(text) - 2], '\r'); /* items are inserted before the line end */
    free(text);
    free(response);
    lensprof_pto_destroy(pto);
}

/* A curve that Hugin's five modes cannot represent: the remainder must be orthogonal to all five, otherwise a closer
 * curve exists. */
static void test_other_responses_are_projected(void **state) {
    (void)state;
    lensprof_response *response = malloc(sizeof *response);
    const double seven[7] = {0.5, 0.1, -0.2, 0.05, 0.01, 0.04, -0.03};
    const lensprof_exposure exposure = {0, {1, 1, 1}};
    for (int kind = 0; kind < 3; kind++) {
        if (kind == 0) lensprof_response_set_linear(response);
        if (kind == 1) assert_ok(lensprof_response_set_gamma(response, 2.2));
        if (kind == 2) assert_ok(lensprof_response_set_emor(response, seven, 7));
        lensprof_pto *pto = read_pto("i w10 h10\n");
        assert_ok(lensprof_pto_set_result(pto, response, &falloff, &exposure, 1, 0, NULL));
        lensprof_pto_image image = image_of(pto, 0);
        double rest[LENSPROF_RESPONSE_SAMPLES];
        for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) {
            rest[j] = response->table[j] - lensprof_emor_table(0)[j];
            for (uint32_t l = 0; l < 5; l++) rest[j] -= image.emor[l] * lensprof_emor_table(l + 1)[j];
        }
        for (uint32_t l = 1; l <= 5; l++) {
            double product = 0;
            for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) product += rest[j] * lensprof_emor_table(l)[j];
            assert_close(product, 0, 1e-4);
        }
        if (kind == 2)
            for (int l = 0; l < 5; l++) assert_close(image.emor[l], seven[l], 1e-4);
        lensprof_pto_destroy(pto);
    }
    free(response);
}

/* Per camera, the first image gets the response and the others are linked to it, whatever they were before; falloffs
 * and exposures stay. */
static void test_cameras(void **state) {
    (void)state;
    const char *text =
        "i w10 h10 Ra0 Rb0 Rc0 Rd0 Re0 Eev1 Er2 Eb3 n\"a\"\ni w10 h10 Ra=0 Rb=0 Rc=0 Rd=0 Re=0 Eev4 n\"b\"\n"
        "i w10 h10 Ra=0 Rb=0 Rc=0 Rd=0 Re=0 Eev5 n\"c\"\ni w10 h10 Ra0.3 Rb0 Rc0 Rd0 Re0 Eev6 n\"d\"\n";
    lensprof_pto *pto = read_pto(text);
    lensprof_response *response = malloc(2 * sizeof *response);
    const double other[2] = {-0.4, 0.1};
    assert_ok(lensprof_response_set_emor(&response[0], emor, 5));
    assert_ok(lensprof_response_set_emor(&response[1], other, 2));
    lensprof_exposure exposures[4];
    for (int i = 0; i < 4; i++) exposures[i] = (lensprof_exposure){0.5 * i, {1, 1, 1}};
    assert_ok(lensprof_pto_set_result(pto, response, &falloff, exposures, 4, 0, NULL));
    const uint32_t camera[4] = {0, 1, 0, 1};
    assert_ok(lensprof_pto_set_cameras(pto, camera, 4, response, 2, NULL));
    char *written = write_pto(pto);
    lensprof_pto *again = read_pto(written);
    for (uint32_t i = 0; i < 4; i++) {
        lensprof_pto_image image;
        lensprof_pto_image_init(&image);
        assert_ok(lensprof_pto_get_image(again, i, &image, NULL));
        assert_int_equal(image.response_of, camera[i]);
        assert_true(image.emor[0] == (camera[i] ? other[0] : emor[0]));
        assert_true(image.emor[4] == (camera[i] ? 0.0 : emor[4]));
        assert_true(image.vignetting.k[0] == falloff.k[0]);
        assert_close(image.exposure.ev, -1.0 + 0.5 * i, 1e-12);
    }
    const uint32_t beyond[4] = {0, 1, 2, 1};
    lensprof_error error;
    assert_int_equal(lensprof_pto_set_cameras(pto, beyond, 4, response, 2, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_set_cameras(pto, camera, 3, response, 2, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_set_cameras(pto, camera, 4, NULL, 2, &error), LENSPROF_ERROR_ARGUMENT);
    response[1].table[5] = 7.0;
    assert_int_equal(lensprof_pto_set_cameras(pto, camera, 4, response, 2, &error), LENSPROF_ERROR_RESPONSE);
    assert_non_null(strstr(error.text, "response 1"));
    char *untouched = write_pto(pto);
    assert_string_equal(written, untouched);
    free(untouched), free(written), free(response);
    lensprof_pto_destroy(again);
    lensprof_pto_destroy(pto);
}

/* Images without an exposure keep theirs, and a comment lists them; a later result replaces the comment. */
static void test_images_that_were_left_out(void **state) {
    (void)state;
    const char *text = "i w10 h10 Eev1 Er2 Eb3 n\"a\"\ni w10 h10 Eev4 Er1 Eb1 n\"b\"\ni w10 h10 Eev5 Er1 Eb1 n\"c\"";
    lensprof_pto *pto = read_pto(text);
    lensprof_response *response = malloc(sizeof *response);
    assert_ok(lensprof_response_set_emor(response, emor, 5));
    lensprof_exposure exposures[3] = {{NAN, {1, 1, 1}}, {0, {1, 1, 1}}, {NAN, {1, 1, 1}}};
    assert_int_equal(lensprof_pto_set_result(pto, response, &falloff, exposures, 3, 0, NULL), LENSPROF_ERROR_ARGUMENT);
    for (int turn = 0; turn < 2; turn++) { /* the second time with image 0 */
        if (turn == 1) exposures[0] = (lensprof_exposure){2, {1, 1, 1}};
        assert_ok(lensprof_pto_set_result(pto, response, &falloff, exposures, 3, 1, NULL));
        char *written = write_pto(pto);
        assert_non_null(strstr(written, turn == 0 ? "\n#-lensprof left_out 0 2\n" : "\n#-lensprof left_out 2\n"));
        const char *mark = strstr(written, "left_out");
        assert_null(strstr(mark + 1, "left_out"));
        lensprof_pto *again = read_pto(written);
        for (uint32_t i = 0; i < 3; i++) {
            lensprof_pto_image image;
            lensprof_pto_image_init(&image);
            assert_ok(lensprof_pto_get_image(again, i, &image, NULL));
            assert_int_equal(image.left_out, i == 2 || (i == 0 && turn == 0));
            if (i == 0) assert_true(image.exposure.ev == (turn == 0 ? -1.0 : -2.0));
            assert_true(image.vignetting.k[0] == falloff.k[0]);
        }
        lensprof_pto_destroy(again);
        free(written);
    }
    exposures[2] = exposures[1];
    assert_ok(lensprof_pto_set_result(pto, response, &falloff, exposures, 3, 1, NULL));
    char *whole = write_pto(pto);
    assert_null(strstr(whole, "left_out"));
    free(whole);
    free(response);
    lensprof_pto_destroy(pto);
}

/* If other images share the exposure of an image that was left out, their exposure is written to it. */
static void test_links_to_an_image_that_was_left_out(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto("i w10 h10 Eev0 Er1 Eb1\ni w10 h10 Eev0 Er1 Eb1\ni w10 h10 Eev=0 Er1 Eb1\n");
    lensprof_response *response = malloc(sizeof *response);
    assert_ok(lensprof_response_set_emor(response, emor, 5));
    const lensprof_exposure exposures[3] = {{NAN, {1, 1, 1}}, {0, {1, 1, 1}}, {0.75, {1.5, 1, 1}}};
    assert_ok(lensprof_pto_set_result(pto, response, &falloff, exposures, 3, 1, NULL));
    free(response);
    for (uint32_t i = 0; i < 3; i++) {
        lensprof_pto_image image;
        lensprof_pto_image_init(&image);
        assert_ok(lensprof_pto_get_image(pto, i, &image, NULL));
        assert_true(image.exposure.ev == (i == 1 ? 0.0 : 0.75));
        assert_true(image.exposure.white_balance[0] == (i == 2 ? 1.5 : 1.0)); /* not shared */
    }
    lensprof_pto_destroy(pto);
}

/* Comments that resemble the mark are ignored and cause no errors. */
static void test_odd_marks(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(
        "#-lensprof left_out 7 -1 x 1e9 0.5 1\ni w10 h10\ni w10 h10\n# lensprof left_out 0\n#-lensprof left_outs 0\n");
    for (uint32_t i = 0; i < 2; i++) {
        lensprof_pto_image image;
        lensprof_pto_image_init(&image);
        assert_ok(lensprof_pto_get_image(pto, i, &image, NULL));
        assert_int_equal(image.left_out, i == 1);
    }
    lensprof_pto_destroy(pto);
}

static void test_set_result_refuses(void **state) {
    (void)state;
    lensprof_response *response = malloc(sizeof *response);
    lensprof_response_set_linear(response);
    lensprof_exposure e[2] = {{0, {1, 1, 1}}, {0, {1, 1, 1}}};
    lensprof_vignetting dark = {{-1, 0, 0}, {0, 0}};
    const char *before = "i w10 h10\ni w10 h10\n";
    lensprof_pto *pto = read_pto(before);
    assert_int_equal(lensprof_pto_set_result(NULL, response, &falloff, e, 2, 0, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_set_result(pto, NULL, &falloff, e, 2, 0, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_set_result(pto, response, NULL, e, 2, 0, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_set_result(pto, response, &falloff, NULL, 2, 0, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_set_result(pto, response, &falloff, e, 1, 0, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_set_result(pto, response, &falloff, e, 2, 2, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_set_result(pto, response, &dark, e, 2, 0, NULL), LENSPROF_ERROR_VIGNETTING);
    e[1].white_balance[2] = 0;
    assert_int_not_equal(lensprof_pto_set_result(pto, response, &falloff, e, 2, 0, NULL), LENSPROF_OK);
    e[1].white_balance[2] = 1;
    response->table[500] = 0;
    assert_int_not_equal(lensprof_pto_set_result(pto, response, &falloff, e, 2, 0, NULL), LENSPROF_OK);
    char *after = write_pto(pto);
    assert_string_equal(after, before);
    free(after);
    free(response);
    lensprof_pto_destroy(pto);
}

static void test_set_name(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(SAMPLE_PTO);
    char name[64];
    assert_ok(lensprof_pto_set_name(pto, 1, "../other folder/2.jpg", NULL));
    assert_ok(lensprof_pto_set_name(pto, 3, "fourth.jpg", NULL)); /* its line has no name yet */
    assert_ok(lensprof_pto_get_name(pto, 1, name, sizeof name, NULL, NULL));
    assert_string_equal(name, "../other folder/2.jpg");
    assert_ok(lensprof_pto_get_name(pto, 3, name, sizeof name, NULL, NULL));
    assert_string_equal(name, "fourth.jpg");
    assert_ok(lensprof_pto_get_name(pto, 0, name, sizeof name, NULL, NULL));
    assert_string_equal(name, "first picture.jpg");
    assert_ok(lensprof_pto_set_name(pto, 1, "second.jpg", NULL));
    assert_ok(lensprof_pto_set_name(pto, 0, "first picture.jpg", NULL));
    char *text = write_pto(pto);
    assert_null(strstr(text, "other folder"));
    lensprof_pto *again = read_pto(text);
    assert_ok(lensprof_pto_get_name(again, 3, name, sizeof name, NULL, NULL));
    assert_string_equal(name, "fourth.jpg");
    lensprof_pto_destroy(again);
    free(text);
    assert_int_equal(lensprof_pto_set_name(pto, 0, "", NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_set_name(pto, 0, "a\"b", NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_set_name(pto, 4, "x", NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_set_name(pto, 0, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
    lensprof_pto_destroy(pto);
}

/* A name that was set and a result added later are both in the text. */
static void test_result_keeps_set_names(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto("i w100 h80 f0 v50 Eev3 n\"a.jpg\"\ni w100 h80 f0 v=0 Eev4 n\"b.jpg\"\n");
    lensprof_response *response = malloc(sizeof *response);
    lensprof_response_set_linear(response);
    lensprof_vignetting vignetting = {{0}, {0}};
    lensprof_exposure exposures[2];
    lensprof_exposure_init(&exposures[0]);
    lensprof_exposure_init(&exposures[1]);
    exposures[1].ev = 2;
    char name[64];
    assert_ok(lensprof_pto_set_name(pto, 1, "pictures/b.jpg", NULL));
    assert_ok(lensprof_pto_set_result(pto, response, &vignetting, exposures, 2, 0, NULL));
    assert_ok(lensprof_pto_get_name(pto, 1, name, sizeof name, NULL, NULL));
    assert_string_equal(name, "pictures/b.jpg");
    assert_ok(lensprof_pto_set_name(pto, 0, "pictures/a.jpg", NULL));
    char *text = write_pto(pto);
    assert_non_null(strstr(text, "Eev1 n\"pictures/b.jpg\""));
    assert_non_null(strstr(text, "Eev3 n\"pictures/a.jpg\""));
    free(text);
    free(response);
    lensprof_pto_destroy(pto);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_unmodified_is_identical),
        cmocka_unit_test(test_write_into_buffers),
        cmocka_unit_test(test_result_reads_back),
        cmocka_unit_test(test_only_the_result_changes),
        cmocka_unit_test(test_links_stay_and_missing_items_come),
        cmocka_unit_test(test_reference_stays),
        cmocka_unit_test(test_other_responses_are_projected),
        cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_images_that_were_left_out),
        cmocka_unit_test(test_links_to_an_image_that_was_left_out),
        cmocka_unit_test(test_odd_marks),
        cmocka_unit_test(test_set_result_refuses),
        cmocka_unit_test(test_set_name),
        cmocka_unit_test(test_result_keeps_set_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
