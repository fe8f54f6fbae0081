/* lensprof_camera_project compared with libpano13, run as pano_trafo of hugin-tools: every lens with every kind of
 * distortion, also beyond the radius at which it turns back, seen through three kinds of panorama. */
#include "support.h"

#include <lensprof/geometry.h>

#define PI 3.14159265358979323846
#define TOLERANCE_PX 1e-4
#define VARIANTS 8
#define POINTS 60

static const uint32_t lenses[] = {
    LENSPROF_PROJECTION_RECTILINEAR,       LENSPROF_PROJECTION_CYLINDRICAL,     LENSPROF_PROJECTION_CIRCULAR_FISHEYE,
    LENSPROF_PROJECTION_FULLFRAME_FISHEYE, LENSPROF_PROJECTION_EQUIRECTANGULAR, LENSPROF_PROJECTION_ORTHOGRAPHIC,
    LENSPROF_PROJECTION_STEREOGRAPHIC,     LENSPROF_PROJECTION_THOBY,           LENSPROF_PROJECTION_EQUISOLID};
#define LENSES (sizeof lenses / sizeof lenses[0])
#define CAMERAS (LENSES * VARIANTS)

typedef struct panorama {
    int projection; /* `f` of a PTO `p` line: 0 rectilinear, 1 cylindrical, 2 equirectangular */
    double width, height, hfov_deg;
} panorama;

static double spread(uint64_t *seed, double half) { return half * (2 * lp_random(seed) - 1); }

/* Variants: 0 plain, 1 radial, 2 shift, 3 shear, 4 translation, 5 translation to a rotated plane, 6 all, 7 all,
 * wide. */
static lensprof_camera make_camera(uint32_t projection, int variant, uint64_t *seed) {
    int all = variant >= 6;
    lensprof_camera camera = {.projection = projection, .width = 1500, .height = 1000};
    if (variant % 2) {
        camera.width = 901;
        camera.height = 1200;
    }
    camera.hfov_deg = 50 + spread(seed, 20);
    if (variant == 7) camera.hfov_deg = projection == LENSPROF_PROJECTION_RECTILINEAR ? 120 : 200;
    camera.yaw_deg = spread(seed, 60);
    camera.pitch_deg = spread(seed, 40);
    camera.roll_deg = spread(seed, 180);
    for (int i = 0; i < 3; i++) {
        if (all || variant == 1) camera.radial[i] = spread(seed, variant == 1 ? 0.3 : 0.05);
        if (all || variant == 4 || variant == 5) camera.translation[i] = spread(seed, 0.3);
    }
    for (int i = 0; i < 2; i++) {
        if (all || variant == 2) camera.shift_px[i] = spread(seed, 40);
        if (all || variant == 3) camera.shear_px[i] = spread(seed, 30);
        if (all || variant == 5) camera.plane_deg[i] = spread(seed, 40);
    }
    return camera;
}

static void write_project(const char *path, const panorama *pano, const lensprof_camera *cameras) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "p f%d w%.0f h%.0f v%.17g n\"TIFF_m\"\nm i0\n", pano->projection, pano->width, pano->height,
            pano->hfov_deg);
    for (size_t i = 0; i < CAMERAS; i++) {
        const lensprof_camera *c = &cameras[i];
        fprintf(file, "i w%u h%u f%u v%.17g r%.17g p%.17g y%.17g a%.17g b%.17g c%.17g d%.17g e%.17g g%.17g t%.17g ",
                c->width, c->height, c->projection, c->hfov_deg, c->roll_deg, c->pitch_deg, c->yaw_deg, c->radial[0],
                c->radial[1], c->radial[2], c->shift_px[0], c->shift_px[1], c->shear_px[0], c->shear_px[1]);
        fprintf(file, "TrX%.17g TrY%.17g TrZ%.17g Tpy%.17g Tpp%.17g j0 Vm5 n\"%zu.tif\"\n", c->translation[0],
                c->translation[1], c->translation[2], c->plane_deg[0], c->plane_deg[1], i);
    }
    assert_int_equal(fclose(file), 0);
}

/* Panorama pixel -> direction, as libpano13 defines its panoramas. */
static void direction_of(const panorama *pano, const double pixel[2], double direction[2]) {
    double x = pixel[0] - pano->width / 2 + 0.5, y = pixel[1] - pano->height / 2 + 0.5;
    double hfov = pano->hfov_deg * PI / 180, distance;
    switch (pano->projection) {
    case 0:
        distance = pano->width / (2 * tan(hfov / 2));
        direction[0] = atan2(x, distance);
        direction[1] = atan2(y, hypot(distance, x));
        break;
    case 1:
        distance = pano->width / hfov;
        direction[0] = x / distance;
        direction[1] = atan(y / distance);
        break;
    default: direction[0] = x * hfov / pano->width; direction[1] = y * hfov / pano->width;
    }
}

/* The points are generated again from the same seed when the answers are read. */
static void random_point(const panorama *pano, uint64_t *seed, double pixel[2]) {
    pixel[0] = floor(1000 * pano->width * lp_random(seed)) / 1000;
    pixel[1] = floor(1000 * pano->height * lp_random(seed)) / 1000;
}

static void ask(const panorama *pano, uint64_t seed) {
    FILE *file = fopen("pano_trafo_points.txt", "w");
    assert_non_null(file);
    for (size_t i = 0; i < CAMERAS; i++) {
        for (int n = 0; n < POINTS; n++) {
            double pixel[2];
            random_point(pano, &seed, pixel);
            fprintf(file, "%zu %.3f %.3f\n", i, pixel[0], pixel[1]);
        }
    }
    assert_int_equal(fclose(file), 0);
    assert_int_equal(system("pano_trafo -r pano_trafo.pto < pano_trafo_points.txt > pano_trafo_answers.txt"), 0);
}

static int in_frame(const lensprof_camera *camera, const double xy[2]) {
    return xy[0] > 0 && xy[0] < camera->width - 1 && xy[1] > 0 && xy[1] < camera->height - 1;
}

/* Largest deviation and number of compared points per lens. */
static void compare(const panorama *pano, const lensprof_camera *cameras, uint64_t seed, double *worst, int *compared) {
    FILE *file = fopen("pano_trafo_answers.txt", "r");
    assert_non_null(file);
    for (size_t i = 0; i < CAMERAS; i++) {
        for (int n = 0; n < POINTS; n++) {
            double pixel[2], direction[2], xy[2], theirs[2];
            random_point(pano, &seed, pixel);
            assert_int_equal(fscanf(file, "%lf %lf", &theirs[0], &theirs[1]), 2);
            direction_of(pano, pixel, direction);
            if (!lensprof_camera_project(&cameras[i], direction[0], direction[1], xy)) {
                /* libpano13 does not see it in the frame either; but it lets Thoby turn back beyond 126 degrees. */
                assert_true(cameras[i].projection == LENSPROF_PROJECTION_THOBY || !in_frame(&cameras[i], theirs));
                continue;
            }
            if (fabs(xy[0]) > 5000 || fabs(xy[1]) > 5000) continue; /* far outside, near the horizon of the lens */
            double apart = hypot(xy[0] - theirs[0], xy[1] - theirs[1]);
            if (!(apart <= TOLERANCE_PX)) {
                print_error("lens %u, variant %zu, panorama f%d, pixel %.3f %.3f: %.6f %.6f, pano_trafo %.6f %.6f\n",
                            cameras[i].projection, i % VARIANTS, pano->projection, pixel[0], pixel[1], xy[0], xy[1],
                            theirs[0], theirs[1]);
                fail();
            }
            worst[i / VARIANTS] = fmax(worst[i / VARIANTS], apart);
            compared[i / VARIANTS]++;
        }
    }
    fclose(file);
}

static void test_project_agrees_with_pano_trafo(void **state) {
    (void)state;
    if (system("command -v pano_trafo > pano_trafo_found.txt 2>&1") != 0) {
        print_message("pano_trafo is missing; install hugin-tools to run this test\n");
        skip();
    }
    const panorama panoramas[] = {{2, 3600, 1800, 360}, {0, 2000, 1400, 110}, {1, 3001, 1500, 240}};
    double worst[LENSES] = {0};
    int compared[LENSES] = {0};
    for (size_t p = 0; p < sizeof panoramas / sizeof panoramas[0]; p++) {
        uint64_t seed = 1000 + p;
        lensprof_camera cameras[CAMERAS];
        for (size_t i = 0; i < CAMERAS; i++) {
            cameras[i] = make_camera(lenses[i / VARIANTS], (int)(i % VARIANTS), &seed);
            assert_ok(lensprof_camera_validate(&cameras[i]));
        }
        write_project("pano_trafo.pto", &panoramas[p], cameras);
        ask(&panoramas[p], seed);
        compare(&panoramas[p], cameras, seed, worst, compared);
    }
    for (size_t i = 0; i < LENSES; i++) {
        print_message("lens %2u: %4d points, largest deviation %.1e px\n", lenses[i], compared[i], worst[i]);
        assert_true(compared[i] > 300);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_project_agrees_with_pano_trafo),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
