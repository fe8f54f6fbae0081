/* Profile blobs: round trips, and rejection of everything else. */
#include "blob_support.h"

enum {
    GOLDEN = 4
};
static const char *const golden_name[GOLDEN] = {"linear", "gamma", "emor", "table"};

/* The profiles of tests/fuzz/corpus/blob, with their covariance. */
static void golden_profile(int which, lensprof_profile *p) {
    const double emor[4] = {0.8, -0.3, 0.125, -0.0625}, knee[4] = {0.0, 0.625, 0.9375, 1.0};
    lensprof_profile_init(p);
    if (which == 0) return;
    strcpy(p->key.camera_maker, "Maker");
    strcpy(p->key.camera_model, "Camera 1");
    strcpy(p->key.lens, "Objektiv 50 mm f/1,8 \xc3\xa4");
    p->key.focal_mm = 50.0, p->key.aperture = 1.8, p->key.distance_m = INFINITY;
    strcpy(p->provenance.method, "transfer");
    strcpy(p->provenance.software, "lensprof 0.1.0");
    p->provenance.created_unix_s = 1600000000;
    p->provenance.images = 6, p->provenance.pairs = 5000;
    p->provenance.heldout_rms = 1.25, p->provenance.inlier_share = 0.96875;
    p->vignetting[0] = (lensprof_vignetting){{-0.375, 0.125, -0.0625}, {0.03125, -0.015625}};
    if (which == 1) {
        p->responses = 3;
        for (int c = 0; c < 3; c++) assert_ok(lensprof_response_set_gamma(&p->response[c], 2.0 + 0.125 * c));
        p->grid.columns = 3, p->grid.rows = 2, p->grid.channels = 1;
        for (int i = 0; i < 6; i++) p->grid.attenuation[i] = 1.0f - 0.03125f * (float)i;
    }
    if (which == 2) {
        assert_ok(lensprof_response_set_emor(&p->response[0], emor, 4));
        p->vignettings = 3;
        for (int c = 1; c < 3; c++) p->vignetting[c] = p->vignetting[0], p->vignetting[c].k[0] -= 0.0625 * c;
        p->covariance_size = 3;
        const double covariance[9] = {0.5, 0.25, -0.125, 0.25, 1.0, 0.0, -0.125, 0.0, 0.75};
        memcpy(p->covariance, covariance, sizeof covariance);
    }
    if (which == 3) {
        p->responses = 3;
        assert_ok(lensprof_response_set_gamma(&p->response[1], 2.25));
        assert_ok(lensprof_response_set_table(&p->response[2], knee, 4));
        p->key.processing = LENSPROF_PROCESSING_RAW;
    }
}

static uint8_t *golden_blob(int which, size_t *bytes) {
    lensprof_profile *p = malloc(sizeof *p);
    golden_profile(which, p);
    uint8_t *blob = pack(p, LENSPROF_PACK_COVARIANCE, bytes);
    free(p);
    return blob;
}

/* A profile filled with a pattern, to detect writes. */
static lensprof_profile *poisoned(void) {
    lensprof_profile *p = malloc(sizeof *p);
    memset(p, 0xA5, sizeof *p);
    p->struct_size = sizeof *p;
    return p;
}

static lensprof_profile *poison, *target;

static int make_poison(void **state) {
    (void)state;
    poison = poisoned(), target = poisoned();
    return 0;
}

static int free_poison(void **state) {
    (void)state;
    free(poison), free(target);
    return 0;
}

#define assert_refused(blob, bytes, status) refused((blob), (bytes), (status), __LINE__)

static void refused(const uint8_t *blob, size_t bytes, lensprof_status status, int line) {
    const lensprof_status said = lensprof_profile_unpack(blob, bytes, target);
    if (said != status) fail_msg("line %d: %s, not %s", line, lensprof_status_name(said), lensprof_status_name(status));
    if (memcmp(target, poison, sizeof *target)) fail_msg("line %d: the profile was written", line);
}

/* ---- round trip ---- */

static void assert_response(const lensprof_response *from, const lensprof_response *to) {
    const int has_samples = from->kind == LENSPROF_RESPONSE_EMOR || from->kind == LENSPROF_RESPONSE_TABLE;
    assert_int_equal(to->kind, from->kind);
    assert_int_equal(to->modes, from->modes);
    assert_true(to->gamma == from->gamma);
    assert_memory_equal(to->emor, from->emor, sizeof to->emor);
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++)
        assert_true(to->table[j] == (has_samples ? (double)(float)from->table[j] : from->table[j]));
}

static void test_random_profiles_come_back(void **state) {
    (void)state;
    uint64_t random = 1;
    lensprof_profile *p = malloc(sizeof *p), *back = poisoned();
    for (int n = 0; n < 400; n++) {
        size_t bytes, again_bytes;
        random_profile(p, &random);
        const uint32_t flags = n % 2 ? LENSPROF_PACK_COVARIANCE : 0;
        uint8_t *blob = pack(p, flags, &bytes);
        assert_ok(lensprof_profile_unpack(blob, bytes, back));
        assert_ok(lensprof_profile_validate(back));
        assert_memory_equal(&back->key, &p->key, sizeof p->key);
        assert_memory_equal(&back->provenance, &p->provenance, sizeof p->provenance);
        assert_int_equal(back->responses, p->responses);
        assert_int_equal(back->vignettings, p->vignettings);
        for (uint32_t c = 0; c < p->responses; c++) assert_response(&p->response[c], &back->response[c]);
        assert_memory_equal(back->vignetting, p->vignetting, p->vignettings * sizeof p->vignetting[0]);
        assert_memory_equal(&back->grid, &p->grid, sizeof p->grid);
        assert_int_equal(back->covariance_size, flags ? p->covariance_size : 0);
        assert_memory_equal(back->covariance, p->covariance,
                            back->covariance_size * back->covariance_size * sizeof(double));
        uint8_t *again = pack(back, flags, &again_bytes);
        assert_int_equal(again_bytes, bytes);
        assert_memory_equal(again, blob, bytes);
        free(blob), free(again);
    }
    free(p), free(back);
}

/* Files that a released lensprof may have written. If this fails, the format has changed and needs a new number. */
static void test_format_is_that_of_the_files(void **state) {
    (void)state;
    for (int which = 0; which < GOLDEN; which++) {
        char name[512];
        size_t bytes;
        uint8_t *blob = golden_blob(which, &bytes), *file = malloc(bytes + 1);
        snprintf(name, sizeof name, "%s/%s.blob", LENSPROF_BLOBS, golden_name[which]);
        FILE *f = fopen(name, "rb");
        if (!f) fail_msg("cannot open %s", name);
        assert_int_equal(fread(file, 1, bytes + 1, f), bytes);
        fclose(f);
        assert_memory_equal(file, blob, bytes);
        free(blob), free(file);
    }
}

static void assert_size(const lensprof_profile *p, size_t expected) {
    size_t bytes = 0;
    assert_ok(lensprof_profile_pack(p, LENSPROF_PACK_COVARIANCE, NULL, 0, &bytes));
    assert_int_equal(bytes, expected);
}

/* The sizes given in docs/blob.md. */
static void test_sizes(void **state) {
    (void)state;
    const double values[4] = {0.0, 0.0, 0.0, 0.0}, line[2] = {0.0, 1.0};
    lensprof_profile *p = malloc(sizeof *p);
    lensprof_profile_init(p);
    assert_size(p, 132);
    assert_ok(lensprof_response_set_gamma(&p->response[0], 2.2));
    assert_size(p, 140);
    assert_ok(lensprof_response_set_emor(&p->response[0], values, 4));
    assert_size(p, 4260);
    p->grid.columns = 16, p->grid.rows = 12, p->grid.channels = 1;
    for (int i = 0; i < 16 * 12; i++) p->grid.attenuation[i] = 1.0f;
    assert_size(p, 5028);
    p->responses = p->vignettings = p->grid.channels = 3;
    for (int c = 0; c < 3; c++) assert_ok(lensprof_response_set_table(&p->response[c], line, 2));
    p->grid.columns = p->grid.rows = 32;
    for (int i = 0; i < 3 * 32 * 32; i++) p->grid.attenuation[i] = 1.0f;
    p->covariance_size = 36;
    assert_size(p, 30092);
    free(p);
}

static void test_any_address(void **state) {
    (void)state;
    for (int which = 0; which < GOLDEN; which++) {
        size_t bytes;
        uint8_t *blob = golden_blob(which, &bytes), *memory = malloc(bytes + 15);
        lensprof_profile *there = poisoned(), *here = poisoned();
        assert_ok(lensprof_profile_unpack(blob, bytes, there));
        for (size_t shift = 0; shift < 8; shift++) {
            size_t packed = 0;
            memcpy(memory + shift, blob, bytes);
            assert_ok(lensprof_profile_unpack(memory + shift, bytes, here));
            assert_memory_equal(here, there, sizeof *here);
            memset(memory, 0, bytes + 8);
            assert_ok(lensprof_profile_pack(here, LENSPROF_PACK_COVARIANCE, memory + shift, bytes, &packed));
            assert_memory_equal(memory + shift, blob, bytes);
        }
        free(blob), free(memory), free(there), free(here);
    }
}

static void test_pack_refuses(void **state) {
    (void)state;
    lensprof_profile *p = malloc(sizeof *p);
    uint8_t blob[200];
    size_t bytes = 7;
    golden_profile(0, p);
    memset(blob, 0xA5, sizeof blob);
    assert_int_equal(lensprof_profile_pack(NULL, 0, blob, sizeof blob, &bytes), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_profile_pack(p, 0, NULL, 1, &bytes), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_profile_pack(p, 2, blob, sizeof blob, &bytes), LENSPROF_ERROR_ARGUMENT);
    p->vignetting[0].k[0] = -2.0;
    assert_int_equal(lensprof_profile_pack(p, 0, blob, sizeof blob, &bytes), LENSPROF_ERROR_VIGNETTING);
    assert_int_equal(bytes, 7);
    golden_profile(0, p);
    assert_int_equal(lensprof_profile_pack(p, 0, blob, 131, &bytes), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(bytes, 132);
    for (size_t i = 0; i < sizeof blob; i++) assert_int_equal(blob[i], 0xA5);
    assert_ok(lensprof_profile_pack(p, 0, blob, sizeof blob, &bytes));
    for (size_t i = 132; i < sizeof blob; i++) assert_int_equal(blob[i], 0xA5);
    free(p);
}

/* ---- damage ---- */

static void test_every_flipped_bit_is_found(void **state) {
    (void)state;
    for (int which = 0; which < GOLDEN; which++) {
        size_t bytes;
        uint8_t *blob = golden_blob(which, &bytes);
        for (size_t bit = 0; bit < 8 * bytes; bit++) {
            blob[bit / 8] ^= (uint8_t)(1 << bit % 8);
            assert_refused(blob, bytes, LENSPROF_ERROR_CORRUPT);
            blob[bit / 8] ^= (uint8_t)(1 << bit % 8);
        }
        free(blob);
    }
}

static void test_every_other_length_is_found(void **state) {
    (void)state;
    for (int which = 0; which < GOLDEN; which++) {
        size_t bytes;
        uint8_t *blob = golden_blob(which, &bytes);
        for (size_t length = 0; length < bytes; length++) {
            uint8_t *cut = malloc(length + 1); /* malloc(0) may be NULL */
            memcpy(cut + 1, blob, length);
            assert_refused(cut + 1, length, LENSPROF_ERROR_CORRUPT);
            if (length >= 16) { /* cut, then sealed again */
                seal(cut + 1, length);
                assert_refused(cut + 1, length, LENSPROF_ERROR_CORRUPT);
            }
            free(cut);
        }
        uint8_t *longer = calloc(1, bytes + 300);
        memcpy(longer, blob, bytes);
        for (size_t more = 1; more <= 300; more += more < 10 ? 1 : 29) {
            assert_refused(longer, bytes + more, LENSPROF_ERROR_CORRUPT);
            seal(longer, bytes + more);
            assert_refused(longer, bytes + more, LENSPROF_ERROR_CORRUPT);
            memcpy(longer, blob, bytes);
            memset(longer + bytes, 0, 300);
        }
        free(blob), free(longer);
    }
    assert_int_equal(lensprof_profile_unpack(NULL, 0, target), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_profile_unpack("LPRF", 4, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_refused((const uint8_t *)"", 0, LENSPROF_ERROR_CORRUPT);
    assert_refused((const uint8_t *)"SQLite format 3\0 and more of it", 32, LENSPROF_ERROR_CORRUPT);
}

static void test_newer_layouts(void **state) {
    (void)state;
    size_t bytes;
    uint8_t *blob = golden_blob(1, &bytes);
    blob[4] = 5; /* not sealed: damaged */
    assert_refused(blob, bytes, LENSPROF_ERROR_CORRUPT);
    seal(blob, bytes);
    assert_refused(blob, bytes, LENSPROF_ERROR_LAYOUT);
    for (size_t length = 16; length < bytes; length++) { /* any content */
        memset(blob + 12, 0xEE, length - 12);
        seal(blob, length);
        assert_refused(blob, length, LENSPROF_ERROR_LAYOUT);
        assert_refused(blob, length - 1, LENSPROF_ERROR_CORRUPT);
    }
    blob[4] = 0, blob[5] = 1;
    seal(blob, bytes);
    assert_refused(blob, bytes, LENSPROF_ERROR_LAYOUT);
    blob[5] = 0; /* layout 0 does not exist */
    seal(blob, bytes);
    assert_refused(blob, bytes, LENSPROF_ERROR_CORRUPT);
    free(blob);
}

/* ---- with a correct CRC ---- */

/* Writes `value` in `count` bytes at an offset of a golden blob, seals it, and expects it to be refused. */
static void refuse_number(int which, size_t offset, uint64_t value, size_t count) {
    size_t bytes;
    uint8_t *blob = golden_blob(which, &bytes);
    put_number(blob + offset, value, count);
    seal(blob, bytes);
    if (lensprof_profile_unpack(blob, bytes, target) != LENSPROF_ERROR_CORRUPT)
        fail_msg("%s blob with %llx at %zu was not refused", golden_name[which], (unsigned long long)value, offset);
    assert_refused(blob, bytes, LENSPROF_ERROR_CORRUPT);
    free(blob);
}

static void refuse_double(int which, size_t offset, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    refuse_number(which, offset, bits, 8);
}

static void refuse_float(int which, size_t offset, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    refuse_number(which, offset, bits, 4);
}

static void test_fixed_fields(void **state) {
    (void)state;
    for (int which = 0; which < GOLDEN; which++) {
        static const uint8_t zero[] = {6, 7, 19, 25, 26, 27};
        for (size_t i = 0; i < sizeof zero; i++) refuse_number(which, zero[i], 1, 1);
        for (uint32_t value = 3; value < 256; value++) refuse_number(which, 12, value, 1); /* processing */
        for (uint64_t value = 0; value < 256; value++) {
            size_t bytes;
            uint8_t *blob = golden_blob(which, &bytes);
            for (size_t at = 13; at < 25; at++) /* every other count contradicts the bytes that follow */
                if (at != 19 && blob[at] != value) refuse_number(which, at, value, 1);
            free(blob);
        }
        for (size_t at = 28; at < 52; at += 8) { /* key: above 0, or -1 */
            refuse_double(which, at, NAN);
            refuse_double(which, at, 0.0);
            refuse_double(which, at, -2.0);
            refuse_double(which, at, at == 44 ? -INFINITY : INFINITY);
        }
        for (size_t at = 52; at < 68; at += 8) { /* centre */
            refuse_double(which, at, NAN);
            refuse_double(which, at, INFINITY);
            refuse_double(which, at, 1.5);
        }
        refuse_double(which, 84, NAN);
        refuse_double(which, 84, 256.0);
        refuse_double(which, 92, NAN);
        refuse_double(which, 92, 1.01);
        for (size_t at = 100; at < 124; at += 8) { /* k */
            refuse_double(which, at, NAN);
            refuse_double(which, at, INFINITY);
            refuse_double(which, at, -3.0);
        }
    }
}

static void test_responses(void **state) {
    (void)state;
    for (uint32_t kind = 1; kind < 256; kind++) refuse_number(0, 124, kind, 1);
    for (size_t at = 125; at < 128; at++) refuse_number(0, at, 1, 1);
    for (int c = 0; c < 3; c++) {
        static const double wrong[] = {0.0, -1.0, 0.09, 10.1};
        for (int i = 0; i < 4; i++) refuse_double(1, 128 + 12 * (size_t)c, wrong[i]);
        refuse_double(1, 128 + 12 * (size_t)c, NAN);
        refuse_double(1, 128 + 12 * (size_t)c, INFINITY);
    }
    const size_t coefficients = 100 + 72 + 4, samples = coefficients + 32; /* of the EMoR blob */
    refuse_number(2, coefficients - 3, 3, 1);                              /* modes: everything after them moves */
    refuse_number(2, coefficients - 3, 5, 1);
    refuse_number(2, coefficients - 3, 255, 1);
    for (size_t l = 0; l < 4; l++) {
        refuse_double(2, coefficients + 8 * l, NAN);
        refuse_double(2, coefficients + 8 * l, -INFINITY);
    }
    refuse_float(2, samples, 1e-30f);
    refuse_float(2, samples + 4 * 1023, 0.99999994f);
    refuse_float(2, samples + 4 * 1023, 1.0000001f);
    for (size_t j = 0; j < 1024; j++) {
        refuse_float(2, samples + 4 * j, NAN);
        refuse_float(2, samples + 4 * j, INFINITY);
        refuse_float(2, samples + 4 * j, -0.1f);
        if (j > 1) refuse_float(2, samples + 4 * j, 0.0f);
        if (j < 1023) refuse_float(2, samples + 4 * j, 1.1f);
    }
}

static void test_grids_covariances_and_texts(void **state) {
    (void)state;
    const size_t grid = 100 + 24 + 36, text = grid + 24; /* of the gamma blob */
    static const float wrong[] = {0.0f, -1.0f, 0.00099f, 1000.1f};
    for (size_t i = 0; i < 6; i++) {
        for (int n = 0; n < 4; n++) refuse_float(1, grid + 4 * i, wrong[n]);
        refuse_float(1, grid + 4 * i, NAN);
        refuse_float(1, grid + 4 * i, INFINITY);
    }
    size_t bytes;
    uint8_t *blob = golden_blob(1, &bytes);
    assert_memory_equal(blob + text, "MakerCamera 1Objektiv", 21);
    for (size_t at = text; at < bytes - 4; at++) {
        refuse_number(1, at, 0, 1);
        refuse_number(1, at, '\n', 1);
        refuse_number(1, at, 0x7f, 1);
    }
    free(blob);
    const size_t covariance = 100 + 72 + 4 + 32 + 4096; /* of the EMoR blob: 00 01 02 11 12 22 */
    for (size_t i = 0; i < 6; i++) {
        refuse_double(2, covariance + 8 * i, NAN);
        refuse_double(2, covariance + 8 * i, INFINITY);
        if (i == 0 || i == 3 || i == 5) refuse_double(2, covariance + 8 * i, -1e-9);
    }
}

/* Sides and counts that need more bytes than a blob can hold, with all those bytes present and with too few. */
static void test_huge_sizes(void **state) {
    (void)state;
    enum {
        ROOM = 1 << 20
    };
    uint8_t *blob = calloc(1, ROOM);
    size_t bytes;
    uint8_t *golden = golden_blob(0, &bytes);
    static const uint8_t huge[][3] = {{3, 33, 33}, {3, 255, 255}, {255, 255, 255}, {1, 1, 2}, {1, 2, 1}, {1, 33, 2},
                                      {1, 2, 33},  {3, 32, 255},  {2, 2, 2},       {1, 0, 2}, {1, 2, 0}, {0, 2, 2}};
    for (size_t n = 0; n < sizeof huge / sizeof huge[0]; n++)
        for (size_t more = 0; more < 2; more++) {
            const size_t nodes = (size_t)huge[n][0] * huge[n][1] * huge[n][2],
                         length = bytes + (more && nodes < 200000 ? 4 * nodes : 0);
            memset(blob, 0, ROOM);
            memcpy(blob, golden, 128);
            memcpy(blob + 15, huge[n], 3);
            for (size_t i = 128; i + 4 < length; i += 4) put_float(blob + i, 1.0f);
            seal(blob, length);
            assert_refused(blob, length, LENSPROF_ERROR_CORRUPT);
        }
    for (size_t n = 37; n < 256; n += 73) { /* a covariance larger than allowed, all bytes present */
        const size_t length = bytes + 8 * n * (n + 1) / 2;
        memset(blob, 0, ROOM);
        memcpy(blob, golden, 128);
        blob[18] = (uint8_t)n;
        seal(blob, length);
        assert_refused(blob, length, LENSPROF_ERROR_CORRUPT);
    }
    for (size_t t = 0; t < 5; t++) { /* texts longer than their fields, all bytes present */
        static const uint8_t room[5] = {64, 64, 128, 32, 32};
        for (size_t length = room[t] - 1u; length <= room[t]; length++) {
            memcpy(blob, golden, 128);
            blob[20 + t] = (uint8_t)length;
            memset(blob + 128, 'x', length);
            seal(blob, bytes + length);
            if (length == room[t])
                assert_refused(blob, bytes + length, LENSPROF_ERROR_CORRUPT);
            else
                assert_ok(lensprof_profile_unpack(blob, bytes + length, target));
            memcpy(target, poison, sizeof *target);
        }
    }
    free(blob), free(golden);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_profiles_come_back),
        cmocka_unit_test(test_format_is_that_of_the_files),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_any_address),
        cmocka_unit_test(test_pack_refuses),
        cmocka_unit_test(test_every_flipped_bit_is_found),
        cmocka_unit_test(test_every_other_length_is_found),
        cmocka_unit_test(test_newer_layouts),
        cmocka_unit_test(test_fixed_fields),
        cmocka_unit_test(test_responses),
        cmocka_unit_test(test_grids_covariances_and_texts),
        cmocka_unit_test(test_huge_sizes),
    };
    return cmocka_run_group_tests(tests, make_poison, free_poison);
}
