/* Hugin 2022 reads written files with the same meaning: nona corrects pictures with a written project and draws the
 * same masks, vig_optimize solves from written points. Skipped without the package hugin-tools. */
#include "core/exposure.h"
#include "pto_support.h"

#include <lensprof/model.h>

#define WIDTH 60
#define HEIGHT 40

static void need(const char *program) {
    char command[100];
    snprintf(command, sizeof command, "command -v %s > hugin_found.txt 2>&1", program);
    if (system(command) != 0) {
        print_message("%s is missing; install hugin-tools to run this test\n", program);
        skip();
    }
}

static void write_file(const char *path, const void *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static char *read_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    char *bytes = malloc(1 << 20);
    *size = fread(bytes, 1, (1 << 20) - 1, file);
    bytes[*size] = '\0';
    fclose(file);
    return bytes;
}

static void write_ppm(const char *path, const uint8_t *pixels) {
    char file[32 + WIDTH * HEIGHT * 3];
    int head = snprintf(file, 32, "P6\n%d %d\n255\n", WIDTH, HEIGHT);
    memcpy(file + head, pixels, WIDTH * HEIGHT * 3);
    write_file(path, file, (size_t)head + WIDTH * HEIGHT * 3);
}

static uint32_t little(const char *bytes, int count) {
    uint32_t value = 0;
    for (int i = count - 1; i >= 0; i--) value = value << 8 | (uint8_t)bytes[i];
    return value;
}

/* Values of a tag of a little-endian TIFF (SHORT or LONG); returns their number. */
static uint32_t tiff_tag(const char *file, uint32_t tag, uint32_t *values) {
    const char *directory = file + little(file + 4, 4);
    for (uint32_t i = 0; i < little(directory, 2); i++) {
        const char *entry = directory + 2 + 12 * i;
        if (little(entry, 2) != tag) continue;
        uint32_t count = little(entry + 4, 4);
        int size = little(entry + 2, 2) == 3 ? 2 : 4;
        const char *data = count * (uint32_t)size <= 4 ? entry + 8 : file + little(entry + 8, 4);
        for (uint32_t k = 0; k < count && k < 200; k++) values[k] = little(data + k * (uint32_t)size, size);
        return count;
    }
    return 0;
}

/* An uncompressed 8-bit RGBA TIFF of WIDTH x HEIGHT, as nona writes it. */
static void read_tiff(const char *path, uint8_t pixels[HEIGHT * WIDTH * 4]) {
    size_t size, done = 0;
    char *file = read_file(path, &size);
    uint32_t value[200], offset[200], bytes[200];
    assert_memory_equal(file, "II*", 4);
    assert_true(tiff_tag(file, 256, value) == 1 && value[0] == WIDTH);
    assert_true(tiff_tag(file, 257, value) == 1 && value[0] == HEIGHT);
    assert_true(tiff_tag(file, 277, value) == 1 && value[0] == 4);
    uint32_t strips = tiff_tag(file, 273, offset);
    assert_int_equal(tiff_tag(file, 279, bytes), strips);
    assert_true(strips > 0 && strips <= 200);
    for (uint32_t i = 0; i < strips; i++) {
        assert_true(done + bytes[i] <= WIDTH * HEIGHT * 4 && offset[i] + bytes[i] <= size);
        memcpy(pixels + done, file + offset[i], bytes[i]);
        done += bytes[i];
    }
    assert_int_equal(done, WIDTH * HEIGHT * 4);
    free(file);
}

static void run_nona(const char *project) {
    write_file("hugin.pto", project, strlen(project));
    assert_int_equal(system("nona -o hugin_out hugin.pto > hugin_nona.txt 2>&1"), 0);
}

/* ---- nona corrects ------------------------------------------------------------------------------------------ */

#define RADIANCE 0.35

static const double emor[5] = {0.7, -0.25, 0.08, 0.03, -0.02};
static const lensprof_vignetting falloff = {{-0.45, 0.12, -0.04}, {0.06, -0.04}};
static const lensprof_exposure taken[2] = {{0.25, {1, 1, 1}}, {-0.6, {1.15, 1, 0.85}}};

/* Renders an evenly lit wall with the model of model.h; returns the largest minus the smallest value. */
static int take_picture(const char *path, const lensprof_response *response, const lensprof_exposure *exposure) {
    uint8_t pixels[HEIGHT * WIDTH * 3];
    int low = 255, high = 0;
    for (int i = 0; i < HEIGHT * WIDTH * 3; i++) {
        double r2 = lensprof_vignetting_r2(&falloff, WIDTH, HEIGHT, i / 3 % WIDTH, i / 3 / WIDTH, NULL);
        double light =
            RADIANCE * lensprof_vignetting_eval(&falloff, r2, NULL) * lp_exposure_factor(exposure, (uint32_t)(i % 3));
        pixels[i] = (uint8_t)lround(255 * lensprof_response_eval(response, light, NULL));
        low = pixels[i] < low ? pixels[i] : low;
        high = pixels[i] > high ? pixels[i] : high;
    }
    write_ppm(path, pixels);
    return high - low;
}

/* Both pictures must show the wall as image 0 would without falloff. */
static void test_nona_corrects_with_a_written_project(void **state) {
    (void)state;
    need("nona");
    lensprof_response *response = malloc(sizeof *response);
    assert_ok(lensprof_response_set_emor(response, emor, 5));
    assert_true(take_picture("hugin0.ppm", response, &taken[0]) > 40);
    assert_true(take_picture("hugin1.ppm", response, &taken[1]) > 40);
    lensprof_pto *pto = read_pto(
        "p f0 w60 h40 v50 k0 E9.5 R0 n\"TIFF_m c:NONE\"\nm i0\n"
        "i w60 h40 f0 v50 Ra0 Rb0 Rc0 Rd0 Re0 Eev9.5 Er1 Eb1 r0 p0 y0 Va1 Vb0 Vc0 Vd0 Vx0 Vy0 "
        "Vm5 n\"hugin0.ppm\"\n"
        "i w60 h40 f0 v=0 Ra=0 Rb=0 Rc=0 Rd=0 Re=0 r0 p0 y0 Va=0 Vb=0 Vc=0 Vd=0 "
        "n\"hugin1.ppm\"\n");
    assert_ok(lensprof_pto_set_result(pto, response, &falloff, taken, 2, 0, NULL));
    char *project = write_pto(pto);
    run_nona(project);
    double expected[3];
    for (uint32_t c = 0; c < 3; c++) /* a picture at Eev = E is shown with exposure factor 1 */
        expected[c] = 255 * lensprof_response_eval(response, RADIANCE * lp_exposure_factor(&taken[0], c), NULL);
    for (int image = 0; image < 2; image++) {
        static uint8_t pixels[HEIGHT * WIDTH * 4];
        double sum[3] = {0}, worst = 0;
        read_tiff(image ? "hugin_out0001.tif" : "hugin_out0000.tif", pixels);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            assert_int_equal(pixels[4 * i + 3], 255);
            for (int c = 0; c < 3; c++) {
                sum[c] += pixels[4 * i + c] - expected[c];
                worst = fmax(worst, fabs(pixels[4 * i + c] - expected[c]));
            }
        }
        print_message("image %d: mean error %.2f %.2f %.2f, largest %.2f levels\n", image, sum[0] / (WIDTH * HEIGHT),
                      sum[1] / (WIDTH * HEIGHT), sum[2] / (WIDTH * HEIGHT), worst);
        for (int c = 0; c < 3; c++) assert_close(sum[c] / (WIDTH * HEIGHT), 0, 0.5);
        assert_true(worst < 3); /* 8-bit input, stretched, and nona dithers */
    }
    free(project);
    free(response);
    lensprof_pto_destroy(pto);
}

/* ---- nona draws the same masks --------------------------------------------------------------------------------- */

/* If a picture is remapped onto itself, its alpha is its mask; pixels on the edge of a circle may differ. */
static void compare_masks(const char *project, uint32_t images, int tolerance) {
    lensprof_pto *pto = read_pto(project);
    run_nona(project);
    for (uint32_t i = 0; i < images; i++) {
        static uint8_t pixels[HEIGHT * WIDTH * 4], mask[HEIGHT * WIDTH];
        char path[32];
        int differ = 0, used = 0;
        snprintf(path, sizeof path, "hugin_out%04u.tif", i);
        read_tiff(path, pixels);
        assert_ok(lensprof_pto_draw_mask(pto, i, mask, WIDTH, HEIGHT, WIDTH, NULL));
        for (int k = 0; k < WIDTH * HEIGHT; k++) {
            differ += mask[k] != (pixels[4 * k + 3] > 127);
            used += mask[k];
        }
        if (differ > tolerance) print_error("image %u: %d pixels differ of %d used\n", i, differ, used);
        assert_true(differ <= tolerance);
        assert_true(used > 100 && used < WIDTH * HEIGHT - 100);
    }
    lensprof_pto_destroy(pto);
}

static void test_nona_draws_the_same_masks(void **state) {
    (void)state;
    need("nona");
    uint8_t grey[HEIGHT * WIDTH * 3];
    memset(grey, 128, sizeof grey);
    write_ppm("hugin0.ppm", grey);
    compare_masks(
        "p f0 w60 h40 v50 E0 R0 n\"TIFF_m c:NONE\"\nm i0\n"
        "i w60 h40 f0 v50 j0 Vm5 S5,50,3,35 n\"hugin0.ppm\"\n"
        "i w60 h40 f0 v=0 j=0 Vm5 n\"hugin0.ppm\"\n"
        "i w60 h40 f0 v=0 j0 Vm5 n\"hugin0.ppm\"\n"
        "i w60 h40 f0 v50 j0 Vm5 S-20,90,7,90 n\"hugin0.ppm\"\n"
        "k i0 t0 p\"20.3 10.2 35.1 12.7 30.4 25.6 18.2 22.9\"\n"
        "k i1 t2 p\"40.3 5.2 55.1 5.7 44.4 15.6\"\n"
        "k i2 t4 p\"2.3 30.2 15.1 28.7 14.4 38.6 3.3 37.1\"\n",
        4, 0);
    compare_masks(
        "p f3 w60 h40 v50 E0 R0 n\"TIFF_m c:NONE\"\nm i0\n"
        "i w60 h40 f2 v50 Vm5 S11,49,2,36 n\"hugin0.ppm\"\n"
        "i w60 h40 f2 v50 Vm5 S-3,57,5,31 n\"hugin0.ppm\"\n"
        "i w60 h40 f3 v50 Vm5 S11,49,2,36 n\"hugin0.ppm\"\n",
        3, 12);
}

/* ---- vig_optimize solves from written points --------------------------------------------------------------------- */

/* Pairs without noise according to the model with EMoR's mean curve; exposures relative to picture 0. */
static void make_pairs(lensprof_pair *pairs, int count, const lensprof_vignetting *vignetting) {
    lensprof_response *response = malloc(sizeof *response);
    uint64_t seed = 77;
    assert_ok(lensprof_response_set_emor(response, emor, 0));
    for (int i = 0; i < count; i++) {
        double radiance = (0.05 + 0.6 * lp_random(&seed)) * exp2(-taken[0].ev);
        for (uint32_t side = 0; side < 2; side++) {
            double x = 600 * lp_random(&seed), y = 400 * lp_random(&seed);
            double r2 = lensprof_vignetting_r2(vignetting, 600, 400, x, y, NULL);
            double light = radiance * lensprof_vignetting_eval(vignetting, r2, NULL);
            pairs[i].image[side] = side;
            pairs[i].xy[side][0] = x;
            pairs[i].xy[side][1] = y;
            for (uint32_t c = 0; c < 3; c++)
                pairs[i].value[side][c] =
                    lensprof_response_eval(response, light * lp_exposure_factor(&taken[side], c), NULL);
        }
    }
    free(response);
}

static void test_vig_optimize_reads_written_points(void **state) {
    (void)state;
    enum {
        PAIRS = 400
    };
    need("vig_optimize");
    const char *project =
        "p f2 w3000 h1500 v360 k0 E0 R0 n\"TIFF_m\"\nm i0\n"
        "i w600 h400 f0 v50 Ra0 Rb0 Rc0 Rd0 Re0 Eev9.5 Er1 Eb1 r0 p0 y0 Va1 Vb0 Vc0 Vd0 Vx0 Vy0 Vm5 "
        "n\"none0.ppm\"\n"
        "i w600 h400 f0 v=0 Ra=0 Rb=0 Rc=0 Rd=0 Re=0 Eev9.5 Er1 Eb1 r0 p0 y25 Va=0 Vb=0 Vc=0 "
        "Vd=0 Vx=0 Vy=0 Vm5 n\"none1.ppm\"\n"
        "v Vb0 Vc0 Vd0\nv Eev1 Er1 Eb1\nv\n";
    static lensprof_pair pairs[PAIRS], again[PAIRS];
    static char text[PAIRS * 400];
    const lensprof_camera cameras[2] = {{.width = 600, .height = 400}, {.width = 600, .height = 400}};
    const lensprof_vignetting centred = {{-0.45, 0.12, -0.04}, {0, 0}};
    make_pairs(pairs, PAIRS, &centred);
    size_t bytes;
    uint32_t found;
    assert_ok(lensprof_points_write(pairs, PAIRS, cameras, 2, text, sizeof text, &bytes, NULL));
    write_file("hugin_points.txt", text, bytes);
    write_file("hugin.pto", project, strlen(project));
    assert_int_equal(system("vig_optimize -i hugin_points.txt -w hugin_points2.txt -o hugin_solved.pto hugin.pto"
                            " > hugin_vig.txt 2>&1"),
                     0);
    char *solved = read_file("hugin_solved.pto", &bytes);
    lensprof_pto *pto = read_pto(solved);
    lensprof_pto_image image = image_of(pto, 1);
    print_message("vig_optimize: ev %.4f, red %.4f, blue %.4f, k %.4f %.4f %.4f\n", image.exposure.ev + 9.5,
                  image.exposure.white_balance[0], image.exposure.white_balance[2], image.vignetting.k[0],
                  image.vignetting.k[1], image.vignetting.k[2]);
    assert_close(image.exposure.ev + 9.5, taken[1].ev - taken[0].ev, 0.005);
    assert_close(image.exposure.white_balance[0], 1.15, 0.005);
    assert_close(image.exposure.white_balance[2], 0.85, 0.005);
    for (double r2 = 0; r2 <= 1; r2 += 0.25)
        assert_close(lensprof_vignetting_eval(&image.vignetting, r2, NULL),
                     lensprof_vignetting_eval(&centred, r2, NULL), 0.005);
    lensprof_pto_destroy(pto);
    free(solved);
    char *points = read_file("hugin_points2.txt", &bytes); /* its output can be read */
    assert_ok(lensprof_points_read(points, bytes, again, PAIRS, &found, NULL));
    assert_int_equal(found, PAIRS);
    for (int i = 0; i < PAIRS; i++) assert_close(again[i].xy[0][0], pairs[i].xy[0][0], 1e-2);
    free(points);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nona_corrects_with_a_written_project),
        cmocka_unit_test(test_nona_draws_the_same_masks),
        cmocka_unit_test(test_vig_optimize_reads_written_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
