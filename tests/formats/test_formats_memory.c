/* Every allocation of every call fails once: MEMORY, outputs untouched, nothing leaked (checked by the address
 * sanitizer). */
#include "pto_support.h"

#include "failing_new.h"
#include "formats/each_format.h"

#include <lensprof/exposures.h>

static const char points[] = "0 1 10.5 20 30 40.25 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0\n";

typedef struct world {
    lensprof_pto *pto;
    lensprof_response response;
    lensprof_exposure exposures[4];
    lensprof_profile *profile;
} world;

static lensprof_status read_again(world *w) {
    (void)w;
    lensprof_pto *untouched = (lensprof_pto *)&untouched, *pto = untouched;
    lensprof_error error;
    lensprof_status status = lensprof_pto_read(SAMPLE_PTO, strlen(SAMPLE_PTO), &pto, &error);
    assert_true((pto == untouched) == (status != LENSPROF_OK));
    if (status == LENSPROF_OK)
        lensprof_pto_destroy(pto);
    else
        assert_non_null(strstr(error.text, "out of memory"));
    return status;
}

static lensprof_status read_wrong(world *w) {
    (void)w;
    const char text[] = "i w10 h10\nv a_name_that_is_far_too_long_for_the_small_string_of_any_library\n";
    lensprof_pto *pto;
    lensprof_status status = lensprof_pto_read(text, strlen(text), &pto, NULL);
    return status == LENSPROF_ERROR_VARIABLE ? LENSPROF_OK : status;
}

static lensprof_status draw(world *w) {
    uint8_t mask[100 * 60];
    memset(mask, 7, sizeof mask);
    lensprof_status status = lensprof_pto_draw_mask(w->pto, 2, mask, 100, 60, 100, NULL);
    for (size_t i = 0; i < sizeof mask; i++) assert_true((mask[i] == 7) == (status != LENSPROF_OK));
    return status;
}

static lensprof_status set_result(world *w) {
    const lensprof_vignetting vignetting = {{-0.2, 0, 0}, {0, 0}};
    return lensprof_pto_set_result(w->pto, &w->response, &vignetting, w->exposures, 4, 0, NULL);
}

static lensprof_status set_cameras(world *w) {
    const uint32_t camera[4] = {0, 0, 0, 0};
    return lensprof_pto_set_cameras(w->pto, camera, 4, &w->response, 1, NULL);
}

static lensprof_status write_points(world *w) {
    (void)w;
    const lensprof_camera cameras[2] = {{.width = 6, .height = 8}, {.width = 6, .height = 8}};
    const lensprof_pair pair = {{0, 1}, {{1, 2}, {3, 4}}, {{0, 0, 0}, {1, 1, 1}}};
    char text[200] = "untouched";
    lensprof_status status = lensprof_points_write(&pair, 1, cameras, 2, text, sizeof text, NULL, NULL);
    assert_true((strcmp(text, "untouched") == 0) == (status != LENSPROF_OK));
    return status;
}

static lensprof_status count_entry(void *user, const lensprof_import_entry *entry) {
    *(int *)user += (int)entry->usable;
    return LENSPROF_OK;
}

static lensprof_status read_lensfun(world *w) {
    (void)w;
    const char text[] =
        "<lensdatabase><camera><maker>A long name of a maker</maker><mount>acme</mount></camera>"
        "<lens><maker>A long name of a maker</maker><model>and of a lens</model><mount>acme</mount>"
        "<cropfactor>1</cropfactor><calibration><vignetting model=\"pa\" focal=\"9\" aperture=\"2\" "
        "distance=\"1\" k1=\"-0.3\"/></calibration></lens></lensdatabase>";
    int entries = 0;
    lensprof_status status = lp_lensfun_read(text, sizeof text - 1, "a file", count_entry, &entries, NULL);
    assert_int_equal(entries, status == LENSPROF_OK);
    return status;
}

static lensprof_status write_lensfun(world *w) {
    const lensprof_profile *const profiles[1] = {w->profile};
    char text[1000] = "untouched";
    size_t needed = 0;
    lensprof_status status = lp_lensfun_write(profiles, 1, NULL, text, sizeof text, &needed, NULL);
    assert_true((strcmp(text, "untouched") == 0) == (status != LENSPROF_OK));
    return status;
}

static lensprof_status read_json(world *w) {
    (void)w;
    const char text[] =
        "{\"profiles\":[{\"key\":{\"lens\":\"A lens with a rather long name\",\"processing\":\"raw\"},"
        "\"vignetting\":{\"k\":[[-0.3,0,0]]},\"response\":{\"kind\":\"emor\",\"emor\":[0.1]},\"a\":[[[]]]}]}";
    int entries = 0;
    lensprof_status status = lp_json_read(text, sizeof text - 1, "a file", count_entry, &entries, NULL);
    assert_int_equal(entries, status == LENSPROF_OK);
    return status;
}

static lensprof_status read_wrong_json(world *w) {
    (void)w;
    int entries = 0;
    const char text[] = "{\"key\":{\"processing\":\"a word that is too long for the small string of any library\"}}";
    lensprof_status status = lp_json_read(text, sizeof text - 1, NULL, count_entry, &entries, NULL);
    return status == LENSPROF_ERROR_SYNTAX ? LENSPROF_OK : status;
}

static lensprof_status write_json(world *w) {
    const lensprof_profile *const profiles[2] = {w->profile, w->profile};
    static char text[100000];
    strcpy(text, "untouched");
    size_t needed = 0;
    lensprof_status status = lp_json_write(profiles, 2, text, sizeof text, &needed, NULL);
    assert_true((strcmp(text, "untouched") == 0) == (status != LENSPROF_OK));
    return status;
}

static lensprof_status read_exposures(world *w) {
    (void)w;
    const char text[] =
        "{\"schema\":1,\"file\":\"lensprof exposures\",\"reference\":\"a name that is too long for a small string\","
        "\"cameras\":[{\"response\":{\"kind\":\"emor\",\"emor\":[0.1]}}],"
        "\"lenses\":[{\"camera\":0,\"vignetting\":{\"k\":[[-0.3,0,0]]}}],"
        "\"images\":[{\"name\":\"a name that is too long for a small string\",\"width\":6,\"height\":4,\"lens\":0,"
        "\"ev\":0,\"white_balance\":[1,1,1]}]}";
    lensprof_exposures *untouched = (lensprof_exposures *)&untouched, *exposures = untouched;
    lensprof_status status = lensprof_exposures_read(text, sizeof text - 1, &exposures, NULL);
    assert_true((exposures == untouched) == (status != LENSPROF_OK));
    if (status == LENSPROF_OK) lensprof_exposures_destroy(exposures);
    return status;
}

static lensprof_status write_exposures(world *w) {
    (void)w;
    lensprof_exposures_info info;
    static lensprof_exposures_camera camera;
    lensprof_exposures_lens lens;
    lensprof_exposures_image image;
    lensprof_exposures_info_init(&info), lensprof_exposures_camera_init(&camera);
    lensprof_exposures_lens_init(&lens), lensprof_exposures_image_init(&image);
    info.camera_count = info.lens_count = info.image_count = 1;
    image.name = "a name that is too long for a small string", image.width = image.height = 6;
    static char text[20000];
    strcpy(text, "untouched");
    lensprof_status status = lensprof_exposures_write(&info, &camera, &lens, &image, text, sizeof text, NULL, NULL);
    assert_true((strcmp(text, "untouched") == 0) == (status != LENSPROF_OK));
    return status;
}

static lensprof_status read_pcalib(world *w) {
    w->response.kind = 99;
    char text[1024] = "";
    for (int i = 0; i < 256; i++) sprintf(text + strlen(text), "%d ", i);
    lensprof_status status = lp_pcalib_read(text, strlen(text), &w->response, NULL);
    assert_true((w->response.kind == 99) == (status != LENSPROF_OK));
    lensprof_response_set_linear(&w->response);
    return status;
}

static lensprof_status read_curves(world *w) {
    const char text[] = "# name: a_name_that_is_far_too_long_for_a_small_string\n0 0 0\n0 1 1\n";
    uint32_t count = 99;
    static lensprof_response responses[3];
    (void)w;
    lensprof_status status = lp_curves_read(text, sizeof text - 1, LENSPROF_CURVE_INVERSE, responses, &count, NULL);
    assert_true((count == 99) == (status != LENSPROF_OK));
    return status;
}

/* All writers of tables. */
static lensprof_status write_tables(world *w) {
    static char text[20000];
    lensprof_status status = lp_pcalib_write(&w->response, text, sizeof text, NULL, NULL);
    if (status != LENSPROF_OK) return status;
    return lp_curves_write(&w->response, 1, LENSPROF_CURVE_LOG, 256, text, sizeof text, NULL, NULL);
}

static lensprof_status read_lcp(world *w) {
    (void)w;
    const char text[] =
        "<rdf:RDF><x:CameraProfiles><rdf:Seq><rdf:li Make=\"A long name of a maker\" FocalLength=\"9\" "
        "ImageWidth=\"60\" ImageLength=\"40\"><PerspectiveModel><VignetteModel FocalLengthX=\"1\" "
        "FocalLengthY=\"1.1\" VignetteModelParam1=\"-0.3\"/></PerspectiveModel></rdf:li></rdf:Seq>"
        "</x:CameraProfiles></rdf:RDF>";
    int entries = 0;
    lensprof_status status = lp_lcp_read(text, sizeof text - 1, "a file", count_entry, &entries, NULL);
    assert_int_equal(entries, status == LENSPROF_OK);
    return status;
}

static lensprof_status write_lcp(world *w) {
    const lensprof_profile *const profiles[1] = {w->profile};
    char text[4000] = "untouched";
    size_t needed = 0;
    lensprof_status status = lp_lcp_write(profiles, 1, 0, 0, text, sizeof text, &needed, NULL);
    assert_true((strcmp(text, "untouched") == 0) == (status != LENSPROF_OK));
    return status;
}

static lensprof_status read_drone_xmp(world *w) {
    (void)w;
    const char text[] =
        "<rdf:RDF><rdf:Description tiff:Make=\"A long name of a maker\" drone-dji:VignettingData=\"0.001, "
        "0.00001, 0.000001\"/></rdf:RDF>";
    int entries = 0;
    lensprof_status status = lp_drone_xmp_read(text, sizeof text - 1, 60, 40, "a file", count_entry, &entries, NULL);
    assert_int_equal(entries, status == LENSPROF_OK);
    return status;
}

static lensprof_status read_opcodes(world *w) {
    (void)w;
    /* a FixVignetteRadial with gain 1 about (0, 0), and a GainMap of one point with gain 1.5 */
    static const uint8_t list[4 + 16 + 56 + 16 + 76 + 4] = {
        [3] = 2,   [7] = 3,   [19] = 56, [4 + 72 + 3] = 9, [4 + 72 + 15] = 80, [103] = 12,   [107] = 18,  [115] = 1,
        [119] = 1, [123] = 1, [127] = 1, [131] = 1,        [167] = 1,          [168] = 0x3F, [169] = 0xC0};
    int entries = 0;
    lensprof_status status =
        lp_dng_opcodes_read(list, sizeof list, 18, 12, LENSPROF_LAYOUT_RGB, "a file", count_entry, &entries, NULL);
    assert_int_equal(entries, status == LENSPROF_OK);
    return status;
}

static lensprof_status write_opcodes(world *w) {
    uint8_t bytes[16384] = {7};
    size_t needed = 0;
    lensprof_status status = lp_dng_opcodes_write(w->profile, 18, 12, LENSPROF_LAYOUT_RGB, LENSPROF_DNG_GAIN_MAP, bytes,
                                                  sizeof bytes, &needed, NULL, NULL);
    assert_true((bytes[0] == 7) == (status != LENSPROF_OK));
    return status;
}

/* A map, a polynomial of radical with a centre per channel, a tuning file: the profile they are read into stays
 * unchanged. */
static lensprof_status read_falloffs(world *w) {
    static float values[16 * 12];
    static char radical[1000];
    const lensprof_map map = {16, 12, 1, LENSPROF_MAP_ATTENUATION, values};
    lensprof_profile *before = malloc(sizeof *before);
    memcpy(before, w->profile, sizeof *before);
    for (int i = 0; i < 16 * 12; i++)
        values[i] = 1 - 0.002f * (float)((i % 16 - 7) * (i % 16 - 7) + (i / 16 - 5) * (i / 16 - 5));
    size_t bytes = 0;
    const char tuning[] =
        "{\"luminance_lut\":[1.1,1.05,1.1,1.05,1,1.05,1.1,1.05,1.1],\"calibrations_Cr\":[{\"ct\":3000,\"table\":"
        "[1.1,1.05,1.1,1.05,1,1.05,1.1,1.05,1.1]}]}";
    lensprof_status status = lp_map_read(&map, 16, 12, w->profile, NULL, NULL);
    if (status == LENSPROF_OK)
        status = lp_radical_vignetting_write(before, 16, 12, radical, sizeof radical, &bytes, NULL);
    if (status == LENSPROF_OK) status = lp_radical_vignetting_read(radical, bytes, w->profile, NULL, NULL);
    if (status == LENSPROF_OK)
        status = lp_alsc_read(tuning, sizeof tuning - 1, 3000, 3, 3, 30, 30, w->profile, NULL, NULL);
    else
        assert_int_equal(status, LENSPROF_ERROR_MEMORY);
    memcpy(w->profile, before, sizeof *before);
    free(before);
    return status;
}

static lensprof_status write_falloffs(world *w) {
    static float values[16 * 12 * 3];
    static char text[30000];
    values[0] = 99;
    lensprof_status status = lensprof_map_write(w->profile, 16, 12, 16, 12, 3, LENSPROF_MAP_GAIN, values, NULL);
    assert_true((values[0] == 99) == (status != LENSPROF_OK));
    if (status != LENSPROF_OK) return status;
    status = lp_radical_response_write(&w->response, 1, text, sizeof text, NULL, NULL);
    if (status != LENSPROF_OK) return status;
    return lp_alsc_write(w->profile, 5000, 16, 12, 160, 120, text, sizeof text, NULL, NULL);
}

static lensprof_status read_points(world *w) {
    (void)w;
    lensprof_pair pair;
    uint32_t found;
    return lensprof_points_read(points, strlen(points), &pair, 1, &found, NULL);
}

static void fail_each(world *w, lensprof_status (*call)(world *), long at_least) {
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

static void test_out_of_memory(void **state) {
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
    fail_each(w, set_cameras, 20);
    fail_each(w, write_points, 1);
    fail_each(w, read_lensfun, 5);
    fail_each(w, write_lensfun, 5);
    fail_each(w, read_lcp, 5);
    fail_each(w, write_lcp, 5);
    fail_each(w, read_drone_xmp, 5);
    fail_each(w, read_opcodes, 5);
    fail_each(w, write_opcodes, 5);
    fail_each(w, read_json, 5);
    fail_each(w, read_wrong_json, 5);
    fail_each(w, write_json, 5);
    fail_each(w, read_exposures, 10);
    fail_each(w, write_exposures, 10);
    fail_each(w, read_pcalib, 2);
    fail_each(w, read_curves, 5);
    fail_each(w, write_tables, 10);
    fail_each(w, read_falloffs, 10);
    fail_each(w, write_falloffs, 10);
    fail_each(w, read_points, 0); /* allocates nothing */
    lensprof_pto_destroy(w->pto);
    free(w->profile);
    free(w);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
