/* Reading Hugin projects: every construct, every error. */
#include "pto_support.h"

static void test_first_image(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(SAMPLE_PTO);
    assert_int_equal(lensprof_pto_image_count(pto), 4);
    lensprof_pto_image image = image_of(pto, 0);
    const lensprof_camera *c = &image.camera;
    assert_int_equal(c->projection, LENSPROF_PROJECTION_RECTILINEAR);
    assert_true(c->width == 400 && c->height == 300 && c->hfov_deg == 55.5);
    assert_true(c->yaw_deg == 10 && c->pitch_deg == -2.5 && c->roll_deg == 1.5);
    assert_true(c->radial[0] == 0.01 && c->radial[1] == -0.02 && c->radial[2] == 0.03);
    assert_true(c->shift_px[0] == 4 && c->shift_px[1] == -5 && c->shear_px[0] == 6 && c->shear_px[1] == -7);
    assert_true(c->translation[0] == 0.1 && c->translation[1] == 0.2 && c->translation[2] == -0.3);
    assert_true(c->plane_deg[0] == 4 && c->plane_deg[1] == -5);
    assert_true(image.exposure.ev == -11.5);
    assert_true(image.exposure.white_balance[0] == 1.25 && image.exposure.white_balance[1] == 1);
    assert_true(image.exposure.white_balance[2] == 0.75);
    assert_true(image.vignetting.k[0] == -0.3 && image.vignetting.k[1] == 0.1 && image.vignetting.k[2] == -0.05);
    assert_close(image.vignetting.center[0], 0.1, 1e-15); /* half the diagonal of 400 x 300 is 250 */
    assert_close(image.vignetting.center[1], -0.2, 1e-15);
    const double emor[5] = {0.5, -0.25, 0.125, 0.01, -0.5};
    assert_memory_equal(image.emor, emor, sizeof emor);
    assert_int_equal(image.response_type, 0);
    const int32_t frame[4] = {0, 0, 400, 300};
    assert_memory_equal(image.crop, frame, sizeof frame);
    assert_int_equal(image.crop_circular, 0);
    lensprof_pto_destroy(pto);
}

static void test_links_resolve_to_the_end_of_the_chain(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(SAMPLE_PTO);
    lensprof_pto_image first = image_of(pto, 0), second = image_of(pto, 1), third = image_of(pto, 2);
    assert_true(second.camera.hfov_deg == 55.5 && third.camera.hfov_deg == 55.5);
    assert_memory_equal(third.camera.radial, first.camera.radial, sizeof first.camera.radial);
    assert_memory_equal(third.emor, first.emor, sizeof first.emor);
    assert_memory_equal(third.vignetting.k, first.vignetting.k, sizeof first.vignetting.k);
    assert_close(third.vignetting.center[0], 25 / (250 * sqrt(2)), 1e-15); /* linked in pixels, of a 500 x 500 frame */
    assert_true(second.exposure.ev == -12.5 && third.exposure.ev == -12.5);
    assert_true(third.exposure.white_balance[0] == 1.25 && third.exposure.white_balance[2] == 1);
    assert_true(second.response_of == 0 && third.response_of == 0 && third.vignetting_of == 0);
    assert_true(third.center_of == 0 && third.ev_of == 1 && third.red_of == 0 && third.blue_of == 1);
    assert_true(second.ev_of == 1 && second.red_of == 0 && second.blue_of == 1 && first.ev_of == 0);
    assert_true(second.camera.yaw_deg == -20 && second.camera.shift_px[0] == 4 && third.camera.shift_px[0] == 0);
    lensprof_pto_destroy(pto);
}

static void test_defaults(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(SAMPLE_PTO);
    lensprof_pto_image image = image_of(pto, 3), expected;
    lensprof_pto_image_init(&expected);
    expected.camera.width = 200;
    expected.camera.height = 100;
    expected.camera.hfov_deg = 50;
    lensprof_exposure_init(&expected.exposure);
    expected.response_of = expected.vignetting_of = expected.center_of = 3;
    expected.ev_of = expected.red_of = expected.blue_of = 3;
    expected.crop[2] = 200;
    expected.crop[3] = 100;
    expected.free = LENSPROF_FREE_BLUE;
    assert_memory_equal(&image, &expected, sizeof image);
    char name[4] = "x";
    assert_ok(lensprof_pto_get_name(pto, 3, name, sizeof name, NULL, NULL));
    assert_string_equal(name, "");
    lensprof_pto_destroy(pto);
}

/* v Ra1 Vb2 Vc0 / Vx0 / Eev2 Er1 Eb3: Ra, Vb and Vx are linked over images 0 to 2, Eev over 1 and 2. */
static void test_variables(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(SAMPLE_PTO);
    uint32_t shared =
        LENSPROF_FREE_RESPONSE | LENSPROF_FREE_K1 | LENSPROF_FREE_K2 | LENSPROF_FREE_CENTER | LENSPROF_FREE_RED;
    assert_int_equal(image_of(pto, 0).free, shared);
    assert_int_equal(image_of(pto, 1).free, shared | LENSPROF_FREE_EV);
    assert_int_equal(image_of(pto, 2).free, shared | LENSPROF_FREE_EV);
    assert_int_equal(image_of(pto, 3).free, LENSPROF_FREE_BLUE);
    lensprof_pto_destroy(pto);
    pto = read_pto(
        "i w10 h10\ni w10 h10\nv Vd1\tVy1\t Re0\n"
        "v Va0 r1 p1 y1 TrX1 TrY1 TrZ1 Tpy1 Tpp1 a0 b0 c0 d0 e0 g0 t0\n");
    assert_int_equal(image_of(pto, 0).free, LENSPROF_FREE_RESPONSE);
    assert_int_equal(image_of(pto, 1).free, LENSPROF_FREE_K3 | LENSPROF_FREE_CENTER);
    lensprof_pto_destroy(pto);
}

static void test_crops(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(SAMPLE_PTO);
    const int32_t second[4] = {20, 30, 380, 290}, third[4] = {-10, 0, 490, 500}, frame[4] = {0, 0, 100, 80};
    assert_memory_equal(image_of(pto, 1).crop, second, sizeof second);
    assert_memory_equal(image_of(pto, 2).crop, third, sizeof third);
    assert_int_equal(image_of(pto, 2).crop_circular, 0); /* f3 fills the frame */
    lensprof_pto_destroy(pto);
    pto = read_pto(
        "i w100 h80 f2 v90 S0,100,0,80\ni w100 h80 f2 v90 S10,90,0,80\ni w100 h80 f8 v90 C10,90,0,80\n"
        "i w100 h80 f20 v90 S10,90,0,80\ni w100 h80 f21 v90 S10,90,0,80\ni w100 h80 S0,0,0,0\n");
    const uint32_t circular[6] = {0, 1, 1, 1, 0, 0};
    for (uint32_t i = 0; i < 6; i++) assert_int_equal(image_of(pto, i).crop_circular, circular[i]);
    assert_memory_equal(image_of(pto, 0).crop, frame, sizeof frame);
    assert_memory_equal(image_of(pto, 5).crop, frame, sizeof frame);
    lensprof_pto_destroy(pto);
}

static void test_vignetting_mode(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(
        "i w30 h40 Va2 Vb-0.5 Vc0.25 Vd0 Vx5 Vm5\ni w30 h40 Va1 Vb-0.5 Vx5\n"
        "i w30 h40 Vb-0.5 Vx5 Vm6 Vf\"flat field.tif\" Rt1\n");
    lensprof_pto_image image = image_of(pto, 0);
    assert_true(image.vignetting.k[0] == -0.25 && image.vignetting.k[1] == 0.125 && image.vignetting.center[0] == 0.2);
    for (uint32_t i = 1; i < 3; i++) {
        const lensprof_vignetting none = {{0}, {0}};
        image = image_of(pto, i);
        assert_memory_equal(&image.vignetting, &none, sizeof none);
    }
    assert_int_equal(image_of(pto, 0).response_type, 0);
    assert_int_equal(image_of(pto, 2).response_type, 1);
    lensprof_pto_destroy(pto);
}

static void test_names(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(SAMPLE_PTO);
    char name[32] = "untouched";
    size_t needed = 0;
    assert_ok(lensprof_pto_get_name(pto, 0, NULL, 0, &needed, NULL));
    assert_int_equal(needed, strlen("first picture.jpg"));
    assert_int_equal(lensprof_pto_get_name(pto, 0, name, needed - 1, NULL, NULL), LENSPROF_ERROR_CAPACITY);
    assert_string_equal(name, "untouched");
    assert_ok(lensprof_pto_get_name(pto, 0, name, needed + 1, &needed, NULL));
    assert_string_equal(name, "first picture.jpg");
    assert_int_equal(lensprof_pto_get_name(pto, 4, name, sizeof name, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
    lensprof_pto_destroy(pto);
}

/* Windows line ends, tabs, a missing final line end, a plus sign, a repeated item (Hugin reads the first). */
static void test_spelling(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(
        "#x\r\ni\tw10\th20\tv+60 y1 y2\tn\"a\tb.jpg\"\r\n\r\n"
        "v Eev0\r\nv\r\n*\r\ni w1 h1 n\"c\"");
    assert_int_equal(lensprof_pto_image_count(pto), 2);
    lensprof_pto_image image = image_of(pto, 0);
    assert_true(image.camera.width == 10 && image.camera.height == 20 && image.camera.hfov_deg == 60);
    assert_true(image.camera.yaw_deg == 1);
    assert_int_equal(image.free, LENSPROF_FREE_EV);
    char name[8];
    assert_ok(lensprof_pto_get_name(pto, 0, name, sizeof name, NULL, NULL));
    assert_string_equal(name, "a\tb.jpg");
    assert_ok(lensprof_pto_get_name(pto, 1, name, sizeof name, NULL, NULL));
    assert_string_equal(name, "c");
    lensprof_pto_destroy(pto);
}

static void assert_refused(const char *text, size_t bytes, lensprof_status status, const char *words) {
    lensprof_pto *untouched = (lensprof_pto *)&untouched, *pto = untouched;
    lensprof_error error;
    assert_int_equal(lensprof_pto_read(text, bytes, &pto, &error), status);
    assert_ptr_equal(pto, untouched);
    if (!strstr(error.text, words)) {
        print_error("\"%s\" does not hold \"%s\"\n", error.text, words);
        fail();
    }
    assert_non_null(strchr(error.text, ';')); /* contains a next step */
    assert_int_equal(lensprof_pto_read(text, bytes, &pto, NULL), status);
}

static void test_errors(void **state) {
    (void)state;
    const struct {
        const char *text;
        lensprof_status status;
        const char *words;
    } cases[] = {
        {"", LENSPROF_ERROR_SYNTAX, "without an image"},
        {"p f2\nv\n", LENSPROF_ERROR_SYNTAX, "without an image"},
        {"i h10\n", LENSPROF_ERROR_SYNTAX, "line 1: w is missing"},
        {"\n\ni w0 h10\n", LENSPROF_ERROR_SYNTAX, "line 3: w is \"0\""},
        {"i w10 h1048577\n", LENSPROF_ERROR_SYNTAX, "h is \"1048577\"; write an integer from 1 to 1048576"},
        {"i w1e9 h10\n", LENSPROF_ERROR_SYNTAX, "w is"},
        {"i w10.5 h10\n", LENSPROF_ERROR_SYNTAX, "w is \"10.5\""},
        {"i w10 h10 f7\n", LENSPROF_ERROR_UNSUPPORTED, "line 1: lens type f7"},
        {"i w10 h10 f9999\n", LENSPROF_ERROR_SYNTAX, "f is"},
        {"i w10 h10 Rt2\n", LENSPROF_ERROR_UNSUPPORTED, "Rt2"},
        {"i w10 h10 v0\n", LENSPROF_ERROR_SYNTAX, "field of view v0"},
        {"i w10 h10 v180\n", LENSPROF_ERROR_SYNTAX, "field of view v180"},
        {"i w10 h10 a2\n", LENSPROF_ERROR_SYNTAX, "not possible"},
        {"i w10 h10 vnan\n", LENSPROF_ERROR_SYNTAX, "v is \"nan\""},
        {"i w10 h10 y-inf\n", LENSPROF_ERROR_SYNTAX, "y is \"-inf\""},
        {"i w10 h10 y1e999\n", LENSPROF_ERROR_SYNTAX, "not a finite number"},
        {"i w10 h10 y\n", LENSPROF_ERROR_SYNTAX, "y is \"\""},
        {"i w10 h10 y1,5\n", LENSPROF_ERROR_SYNTAX, "y is \"1,5\""},
        {"i w10 h10 y0x10\n", LENSPROF_ERROR_SYNTAX, "y is"},
        {"i w10 h10 v=0\n", LENSPROF_ERROR_SYNTAX, "v=0 in image 0"},
        {"i w10 h10\ni w10 h10 v=1\n", LENSPROF_ERROR_SYNTAX, "line 2: v=1"},
        {"i w10 h10\ni w10 h10 v=-1\n", LENSPROF_ERROR_SYNTAX, "v=-1"},
        {"i w10 h10\ni w10 h10 v=\n", LENSPROF_ERROR_SYNTAX, "v="},
        {"i w10 h10 Er0\n", LENSPROF_ERROR_SYNTAX, "Er or Eb"},
        {"i w10 h10 Va0 Vm5\n", LENSPROF_ERROR_SYNTAX, "Va"},
        {"i w10 h10 S1,2,3\n", LENSPROF_ERROR_SYNTAX, "crop S is \"1,2,3\""},
        {"i w10 h10 S1,2,3,4,5\n", LENSPROF_ERROR_SYNTAX, "crop"},
        {"i w10 h10 C1,2,3,99999999\n", LENSPROF_ERROR_SYNTAX, "crop C"},
        {"i w10 h10 n\"a.jpg\n", LENSPROF_ERROR_SYNTAX, "line 1: unterminated quote"},
        {"i w10 h10\nv Eev0 Ev1\n", LENSPROF_ERROR_VARIABLE, "line 2: variable \"Ev1\" is unknown; use one of v y"},
        {"i w10 h10\nv Eev1\n", LENSPROF_ERROR_VARIABLE, "\"Eev1\" refers to no image of the project; write Eev with"},
        {"i w10 h10\nv Eev\n", LENSPROF_ERROR_VARIABLE, "\"Eev\" refers to no image"},
        {"i w10 h10\nv Eev-1\n", LENSPROF_ERROR_VARIABLE, "images 0 to 0 exist"},
        {"i w10 h10\nv j0\n", LENSPROF_ERROR_VARIABLE, "\"j0\" is unknown"},
        {"i w10 h10\nv 0\n", LENSPROF_ERROR_VARIABLE, "\"0\" is unknown"},
        {"i w10 h10\nk t0 p\"1 2 3 4 5 6\"\n", LENSPROF_ERROR_SYNTAX, "line 2: i is missing"},
        {"i w10 h10\nk i1 t0 p\"1 2 3 4 5 6\"\n", LENSPROF_ERROR_SYNTAX, "i is \"1\""},
        {"i w10 h10\nk i0 t5 p\"1 2 3 4 5 6\"\n", LENSPROF_ERROR_SYNTAX, "t is \"5\""},
        {"i w10 h10\nk i0 t0 p\"1 2 3 4 5\"\n", LENSPROF_ERROR_SYNTAX, "mask corner 2"},
        {"i w10 h10\nk i0 t0 p\"1 2 3 4 5 x\"\n", LENSPROF_ERROR_SYNTAX, "mask corner 2 is \"5 x\""},
        {"i w10 h10\nk i0 t0 p\"1 2 3 4 5 1e300\"\n", LENSPROF_ERROR_SYNTAX, "mask corner 2"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_refused(cases[i].text, strlen(cases[i].text), cases[i].status, cases[i].words);
    assert_refused("i w10 h10\nx\0y\n", 14, LENSPROF_ERROR_SYNTAX, "line 2: zero byte");
}

static void test_limits(void **state) {
    (void)state;
    const char line[] = "i w1 h1\n";
    size_t length = strlen(line), images = 100001;
    char *text = malloc(images * length);
    for (size_t i = 0; i < images; i++) memcpy(text + i * length, line, length);
    assert_refused(text, images * length, LENSPROF_ERROR_UNSUPPORTED, "line 100001: more than 100000 images");
    lensprof_pto *pto;
    assert_ok(lensprof_pto_read(text, (images - 1) * length, &pto, NULL));
    assert_int_equal(lensprof_pto_image_count(pto), 100000);
    lensprof_pto_destroy(pto);
    free(text);
    size_t huge = ((size_t)64 << 20) + 1;
    text = malloc(huge);
    memset(text, '#', huge);
    assert_refused(text, huge, LENSPROF_ERROR_SIZE, "64 MiB");
    free(text);
}

static void test_arguments(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto("i w10 h10\n");
    lensprof_pto_image image;
    lensprof_error error;
    lensprof_pto_image_init(&image);
    assert_int_equal(lensprof_pto_read(NULL, 0, &pto, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_read("", 0, NULL, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_get_image(pto, 1, &image, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_get_image(pto, 0, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_get_image(NULL, 0, &image, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_get_name(pto, 0, NULL, 5, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_image_count(NULL), 0);
    lensprof_pto_destroy(pto);
    lensprof_pto_destroy(NULL);
}

/* Hugin evaluates a falling response as its running maximum. */
static void test_response_as_hugin_sees_it(void **state) {
    (void)state;
    lensprof_response response;
    lensprof_pto *pto = read_pto("i w8 h4 Ra0.5\ni w8 h4 Rt1 Ra3\ni w8 h4 Ra20\n");
    assert_ok(lensprof_pto_get_response(pto, 0, &response, NULL));
    assert_int_equal(response.kind, LENSPROF_RESPONSE_EMOR);
    assert_close(response.table[300], lensprof_emor_table(0)[300] + 0.5 * lensprof_emor_table(1)[300], 1e-12);
    assert_ok(lensprof_pto_get_response(pto, 1, &response, NULL));
    assert_int_equal(response.kind, LENSPROF_RESPONSE_LINEAR);
    assert_ok(lensprof_pto_get_response(pto, 2, &response, NULL));
    assert_int_equal(response.kind, LENSPROF_RESPONSE_TABLE);
    assert_ok(lensprof_response_validate(&response));
    double highest = 0.0;
    for (int j = 1; j < 1023; j++) {
        highest = fmax(highest, lensprof_emor_table(0)[j] + 20 * lensprof_emor_table(1)[j]);
        assert_close(response.table[j], fmin(highest, 1.0), 1e-12);
    }
    assert_int_equal(lensprof_pto_get_response(pto, 3, &response, NULL), LENSPROF_ERROR_ARGUMENT);
    lensprof_pto_destroy(pto);
}

/* The radius and angle of a pixel of an equidistant fisheye: v is the angle of the whole width. */
static double angle_deg(double v, double width, double px) { return v / width * px; }

/* Two circles in one file: each image is its circle, which has its own middle and radius. */
static void test_two_circles(void **state) {
    (void)state;
    static const struct {
        int width, height;
        double v[2];
        int crop[2][4]; /* left, right, top, bottom */
        int lens;
    } files[] = {{1024, 512, {380, 414}, {{0, 512, 0, 512}, {512, 1024, 0, 512}}, 2},
                 {3840, 1920, {372.5, 372.5}, {{-12, 1932, -12, 1932}, {1908, 3852, -12, 1932}}, 2},
                 {7776, 3888, {396, 391}, {{10, 3878, 10, 3878}, {3898, 7766, 10, 3878}}, 3},
                 {1000, 2000, {190, 200}, {{0, 1000, 0, 1000}, {0, 1000, 1000, 2000}}, 2},
                 {2560, 1280, {400, 400}, {{1280, 2560, 0, 1280}, {0, 1280, 0, 1280}}, 2}};
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        char text[1000];
        size_t end = 0;
        for (int i = 0; i < 2; i++) {
            const int *c = files[f].crop[i];
            end += (size_t)snprintf(text + end, sizeof text - end,
                                    "i w%d h%d f%d v%g y%d d%g e%g Va1 Vb0 Vc0 Vd0 S%d,%d,%d,%d Vm5 n\"a.jpg\"\n",
                                    files[f].width, files[f].height, files[f].lens, files[f].v[i], 180 * i,
                                    0.5 * (c[0] + c[1] - files[f].width), 0.5 * (c[2] + c[3] - files[f].height), c[0],
                                    c[1], c[2], c[3]);
        }
        lensprof_pto *pto = read_pto(text);
        for (uint32_t i = 0; i < 2; i++) {
            const lensprof_pto_image image = image_of(pto, i);
            const int *c = files[f].crop[i];
            assert_int_equal(image.of_crop, 1);
            const double half = 0.5 * hypot(c[1] - c[0], c[3] - c[2]), x = 0.5 * (c[0] + c[1]) - 0.5,
                         y = 0.5 * (c[2] + c[3]) - 0.5;
            double direction[2];
            const double out = 0.4 * (c[1] - c[0]);
            assert_int_equal(lensprof_camera_unproject(&image.camera, x, y + out, direction), 1);
            assert_close(
                fabs(direction[1]),
                fmin(angle_deg(files[f].v[i], files[f].width, out), 180 - angle_deg(files[f].v[i], files[f].width, out))
                    * M_PI / 180,
                1e-9);
            /* A falloff about the circle's middle in the circle's terms is Hugin's polynomial of the whole file. */
            const lensprof_vignetting falloffs[2] = {{{-.4, .1, -.2}, {.02, -.01}}, {{-.2, 0, -.1}, {0, .03}}};
            const uint32_t settings[2] = {0, 1};
            assert_ok(lensprof_pto_set_settings(pto, settings, 2, falloffs, 2, NULL));
            const lensprof_pto_image again = image_of(pto, i);
            for (int n = 0; n < 3; n++) assert_close(again.vignetting.k[n], falloffs[i].k[n], 1e-12);
            for (int n = 0; n < 2; n++) assert_close(again.vignetting.center[n], falloffs[i].center[n], 1e-12);
            char *written = write_pto(pto), *line = written;
            for (uint32_t n = 0; n < i; n++) line = strchr(line, '\n') + 1;
            const double b = strtod(strstr(line, " Vb") + 3, NULL), cc = strtod(strstr(line, " Vc") + 3, NULL),
                         d = strtod(strstr(line, " Vd") + 3, NULL), vx = strtod(strstr(line, " Vx") + 3, NULL),
                         vy = strtod(strstr(line, " Vy") + 3, NULL);
            for (int step = 0; step < 5; step++) {
                const double px = x + 0.17 * half * step - 3, py = y - 0.1 * half * step;
                const double ours = lensprof_vignetting_eval(
                    &again.vignetting,
                    lensprof_vignetting_r2(&again.vignetting, (uint32_t)(c[1] - c[0]), (uint32_t)(c[3] - c[2]),
                                           px - c[0], py - c[2], NULL),
                    NULL);
                const double whole = hypot(files[f].width, files[f].height) / 2;
                const double r2 =
                    pow(hypot(px - (files[f].width - 1) / 2.0 - vx, py - (files[f].height - 1) / 2.0 - vy) / whole, 2);
                assert_close(ours, 1 + r2 * (b + r2 * (cc + r2 * d)), 1e-9);
            }
            free(written);
        }
        lensprof_pto_destroy(pto);
    }
}

/* One crop of a file, and equal crops, are of the frame as before; what no lens has is refused. */
static void test_single_crops(void **state) {
    (void)state;
    static const char *const of_frame[] = {
        "i w800 h600 f2 v180 S100,700,0,600 Vb-0.3 Vm5 n\"a\"\n",
        "i w800 h600 f0 v50 S400,800,0,600 Vb-0.3 Vm5 n\"a\"\n",
        "i w800 h600 f0 v50 S10,700,0,600 Vb-0.3 Vm5 n\"a\"\ni w800 h600 f0 v50 S10,700,0,600 Vb-0.3 Vm5 n\"a\"\n",
        "i w800 h600 f0 v50 S10,700,0,600 Vb-0.3 Vm5 n\"a\"\ni w800 h600 f0 v50 S20,700,0,600 Vb-0.3 Vm5 n\"b\"\n"};
    for (size_t i = 0; i < sizeof of_frame / sizeof *of_frame; i++) {
        lensprof_pto *pto = read_pto(of_frame[i]);
        assert_int_equal(image_of(pto, 0).of_crop, 0);
        assert_true(image_of(pto, 0).vignetting.k[0] == -0.3);
        lensprof_pto_destroy(pto);
    }
    lensprof_pto *pto = read_pto("i w1024 h512 f2 v380 S512,1024,0,512 n\"a\"\n");
    assert_int_equal(image_of(pto, 0).of_crop, 1); /* a circle off the middle of its file */
    lensprof_pto_destroy(pto);
    static const char *const refused[] = {"f2 v0",   "f3 v-10", "f3 v3700", "f2 v1e9", "f0 v190",
                                          "f1 v380", "f4 v380", "f10 v380", "f21 v380"};
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        char text[100];
        snprintf(text, sizeof text, "i w1024 h512 %s S0,512,0,512 n\"a\"\n", refused[i]);
        assert_int_equal(lensprof_pto_read(text, strlen(text), &pto, NULL), LENSPROF_ERROR_SYNTAX);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_first_image), cmocka_unit_test(test_links_resolve_to_the_end_of_the_chain),
        cmocka_unit_test(test_defaults),    cmocka_unit_test(test_variables),
        cmocka_unit_test(test_crops),       cmocka_unit_test(test_vignetting_mode),
        cmocka_unit_test(test_names),       cmocka_unit_test(test_spelling),
        cmocka_unit_test(test_errors),      cmocka_unit_test(test_limits),
        cmocka_unit_test(test_arguments),   cmocka_unit_test(test_response_as_hugin_sees_it),
        cmocka_unit_test(test_two_circles), cmocka_unit_test(test_single_crops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
