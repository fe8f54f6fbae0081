/* Damaged projects and point files: always a status, never a crash; accepted ones can be used and written. */
#include "pto_support.h"

#define MUTATIONS 5000
#define ROOM 8192

static size_t pick(uint64_t *seed, size_t below) { return below ? (size_t)(lp_random(seed) * (double)below) : 0; }

/* A random size; small ones are more frequent. */
static size_t pick_size(uint64_t *seed, size_t most) {
    size_t divisor = 1 + pick(seed, 20);
    return pick(seed, most + 1) / divisor;
}

/* One change: a byte, a removed or repeated piece, or a word that is difficult for parsers. */
static size_t mutate(char *text, size_t length, uint64_t *seed) {
    static const char *const words[] = {"\n",
                                        "\r",
                                        " ",
                                        "\"",
                                        "=",
                                        "=0",
                                        "=99999999999",
                                        "nan",
                                        "inf",
                                        "-",
                                        "1e309",
                                        "1e-400",
                                        "99999999999999999999",
                                        "-1",
                                        "i w10 h10 ",
                                        "\nv ",
                                        "\nk i0 t1 p\"",
                                        "0x1p3",
                                        ",",
                                        "\t",
                                        "v",
                                        "n\"",
                                        "S1,2,3,4",
                                        "f8",
                                        "f20",
                                        "+",
                                        "4294967296"};
    char byte;
    const char *piece = &byte;
    size_t at = pick(seed, length + 1), cut = 0, size = 1;
    switch (pick(seed, 4)) {
    case 0:
        byte = (char)pick(seed, 256);
        cut = at < length;
        break;
    case 1:
        cut = pick_size(seed, length - at);
        size = 0;
        break;
    case 2:
        piece = text + pick(seed, length);
        size = pick_size(seed, (size_t)(text + length - piece));
        break;
    default: piece = words[pick(seed, sizeof words / sizeof words[0])]; size = strlen(piece);
    }
    if (length - cut + size > ROOM) return length;
    char copy[ROOM];
    memcpy(copy, piece, size);
    memmove(text + at + size, text + at + cut, length - at - cut);
    memcpy(text + at, copy, size);
    return length - cut + size;
}

static void use(lensprof_pto *pto, const lensprof_response *response) {
    uint32_t count = lensprof_pto_image_count(pto);
    lensprof_exposure *exposures = calloc(count, sizeof *exposures);
    const lensprof_vignetting vignetting = {{-0.2, 0, 0}, {0, 0}};
    assert_true(count > 0);
    for (uint32_t i = 0; i < count; i++) {
        uint8_t mask[12 * 9];
        lensprof_pto_image image = image_of(pto, i);
        assert_ok(lensprof_camera_validate(&image.camera));
        assert_true(image.response_of <= i && image.vignetting_of <= i && image.center_of <= i && image.ev_of <= i);
        assert_ok(lensprof_pto_draw_mask(pto, i, mask, 12, 9, 12, NULL));
        lensprof_exposure_init(&exposures[i]);
    }
    assert_ok(lensprof_pto_set_result(pto, response, &vignetting, exposures, count, count / 2, NULL));
    char *text = write_pto(pto);
    lensprof_pto_destroy(read_pto(text));
    free(text);
    free(exposures);
}

static void test_projects(void **state) {
    (void)state;
    lensprof_response *response = malloc(sizeof *response);
    lensprof_response_set_linear(response);
    char *text = malloc(ROOM);
    uint64_t seed = 11;
    int accepted = 0, kinds[100] = {0};
    for (int n = 0; n < MUTATIONS; n++) {
        size_t length = strlen(SAMPLE_PTO), changes = 1 + pick(&seed, 4);
        memcpy(text, SAMPLE_PTO, length);
        for (size_t i = 0; i < changes; i++) length = mutate(text, length, &seed);
        char *exact = malloc(length + 1); /* exactly that size: the address sanitizer detects every overrun */
        memcpy(exact, text, length);
        lensprof_pto *pto = NULL;
        lensprof_error error;
        lensprof_status status = lensprof_pto_read(exact, length, &pto, &error);
        free(exact);
        kinds[status]++;
        assert_true(!pto == (status != LENSPROF_OK));
        assert_true((error.text[0] == '\0') == (status == LENSPROF_OK));
        if (pto) {
            accepted++;
            use(pto, response);
        }
        lensprof_pto_destroy(pto);
    }
    print_message("%d of %d accepted, %d syntax, %d variable, %d unsupported\n", accepted, MUTATIONS,
                  kinds[LENSPROF_ERROR_SYNTAX], kinds[LENSPROF_ERROR_VARIABLE], kinds[LENSPROF_ERROR_UNSUPPORTED]);
    assert_int_equal(
        accepted + kinds[LENSPROF_ERROR_SYNTAX] + kinds[LENSPROF_ERROR_VARIABLE] + kinds[LENSPROF_ERROR_UNSUPPORTED],
        MUTATIONS);
    assert_true(accepted > MUTATIONS / 10 && accepted < MUTATIONS * 9 / 10);
    free(text);
    free(response);
}

static void test_points(void **state) {
    (void)state;
    const char sample[] =
        "0 1 10.5 20 30 40.25 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0\r\n\n"
        "7 2\t-1 2e1 3 4 0 1 0.5 1 0 +.25 0 0 0 0\n";
    char *text = malloc(ROOM);
    uint64_t seed = 12;
    for (int n = 0; n < MUTATIONS; n++) {
        size_t length = strlen(sample);
        memcpy(text, sample, length);
        length = mutate(text, mutate(text, length, &seed), &seed);
        char *exact = malloc(length + 1);
        memcpy(exact, text, length);
        lensprof_pair pairs[50];
        uint32_t found = 0;
        lensprof_error error;
        lensprof_status status = lensprof_points_read(exact, length, pairs, 50, &found, &error);
        free(exact);
        assert_true(status == LENSPROF_OK || status == LENSPROF_ERROR_SYNTAX || status == LENSPROF_ERROR_CAPACITY);
        for (uint32_t i = 0; status == LENSPROF_OK && i < found; i++)
            for (int c = 0; c < 6; c++) {
                double value = pairs[i].value[c / 3][c % 3];
                assert_true(value >= 0 && value <= 1);
            }
    }
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_projects),
        cmocka_unit_test(test_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
