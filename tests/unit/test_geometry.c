/* Camera projections: exact points, limits, and the round trip for every lens. The comparison with libpano13 is in
 * tests/formats/test_pano_trafo.c. */
#include "support.h"

#include <lensprof/geometry.h>

#define PI 3.14159265358979323846
#define DEGREE (PI / 180)

static const uint32_t lenses[] = {
    LENSPROF_PROJECTION_RECTILINEAR,       LENSPROF_PROJECTION_CYLINDRICAL,     LENSPROF_PROJECTION_CIRCULAR_FISHEYE,
    LENSPROF_PROJECTION_FULLFRAME_FISHEYE, LENSPROF_PROJECTION_EQUIRECTANGULAR, LENSPROF_PROJECTION_ORTHOGRAPHIC,
    LENSPROF_PROJECTION_STEREOGRAPHIC,     LENSPROF_PROJECTION_THOBY,           LENSPROF_PROJECTION_EQUISOLID};
#define LENSES (sizeof lenses / sizeof lenses[0])

static lensprof_camera plain_camera(uint32_t projection, double hfov_deg) {
    lensprof_camera camera = {.projection = projection, .width = 1200, .height = 800, .hfov_deg = hfov_deg};
    assert_ok(lensprof_camera_validate(&camera));
    return camera;
}

static void assert_pixel(const lensprof_camera *camera, double longitude, double latitude, double x, double y) {
    double xy[2] = {-1e9, -1e9};
    assert_int_equal(lensprof_camera_project(camera, longitude, latitude, xy), 1);
    assert_close(xy[0], x, 1e-9);
    assert_close(xy[1], y, 1e-9);
}

static void assert_unseen(const lensprof_camera *camera, double longitude, double latitude) {
    double xy[2] = {7, 8};
    assert_int_equal(lensprof_camera_project(camera, longitude, latitude, xy), 0);
    assert_true(xy[0] == 7 && xy[1] == 8);
}

/* By definition, half the field of view ends at the right edge of the last pixel, for every lens. */
static void test_centre_and_edges(void **state) {
    (void)state;
    for (size_t i = 0; i < LENSES; i++) {
        lensprof_camera camera = plain_camera(lenses[i], 100);
        assert_pixel(&camera, 0, 0, 599.5, 399.5);
        assert_pixel(&camera, 50 * DEGREE, 0, 1199.5, 399.5);
        assert_pixel(&camera, -50 * DEGREE, 0, -0.5, 399.5);
    }
    lensprof_camera wide = plain_camera(LENSPROF_PROJECTION_ORTHOGRAPHIC, 180);
    assert_pixel(&wide, PI / 2, 0, 1199.5, 399.5);
}

/* Radius of a direction 40 degrees off the axis, from the textbook formula of each lens. */
static void test_lens_formulas(void **state) {
    (void)state;
    const double angle = 40 * DEGREE, half = 50 * DEGREE;
    const double ratio[LENSES] = {tan(angle) / tan(half),
                                  0.8,
                                  0.8,
                                  0.8,
                                  0.8,
                                  sin(angle) / sin(half),
                                  tan(angle / 2) / tan(half / 2),
                                  sin(0.713 * angle) / sin(0.713 * half),
                                  sin(angle / 2) / sin(half / 2)};
    for (size_t i = 0; i < LENSES; i++) {
        lensprof_camera camera = plain_camera(lenses[i], 100);
        assert_pixel(&camera, angle, 0, 599.5 + 600 * ratio[i], 399.5);
        if (lenses[i] == LENSPROF_PROJECTION_CYLINDRICAL) {
            assert_pixel(&camera, 0, angle, 599.5, 399.5 + 1200 / (100 * DEGREE) * tan(angle));
        } else {
            assert_pixel(&camera, 0, angle, 599.5, 399.5 + 600 * ratio[i]);
        }
    }
}

/* The optical axis points to (yaw, -pitch); roll turns the picture clockwise. */
static void test_rotation(void **state) {
    (void)state;
    for (size_t i = 0; i < LENSES; i++) {
        lensprof_camera camera = plain_camera(lenses[i], 100);
        camera.yaw_deg = 130;
        camera.pitch_deg = 25;
        camera.roll_deg = -70;
        assert_pixel(&camera, 130 * DEGREE, -25 * DEGREE, 599.5, 399.5);
    }
    lensprof_camera camera = plain_camera(LENSPROF_PROJECTION_CIRCULAR_FISHEYE, 120);
    camera.roll_deg = 90;
    assert_pixel(&camera, 0.5, 0, 599.5, 399.5 - 0.5 * 1200 / (120 * DEGREE));
}

/* Plane z = 1: the point (1, 0, 1) is straight ahead after moving right by 1, at slope 1/1.5 after moving back by 0.5,
 * and invisible from the other side of the plane. */
static void test_translation(void **state) {
    (void)state;
    lensprof_camera camera = plain_camera(LENSPROF_PROJECTION_RECTILINEAR, 90);
    camera.translation[0] = 1;
    assert_pixel(&camera, 45 * DEGREE, 0, 599.5, 399.5);
    assert_unseen(&camera, 135 * DEGREE, 0);
    camera.translation[0] = 0;
    camera.translation[1] = 0.25;
    assert_pixel(&camera, 0, 0, 599.5, 399.5 - 150);
    camera.translation[1] = 0;
    camera.translation[2] = 0.5;
    assert_pixel(&camera, 45 * DEGREE, 0, 599.5 + 600 / 1.5, 399.5);
    camera.plane_deg[0] = 30; /* now the plane faces yaw 30: at distance 1 from the centre there */
    camera.yaw_deg = 30;
    camera.translation[0] = -sin(30 * DEGREE);
    camera.translation[2] = cos(30 * DEGREE); /* one unit back along that axis */
    assert_pixel(&camera, 75 * DEGREE, 0, 599.5 + 600 / 2.0, 399.5);
}

static void test_distortion_shift_and_shear(void **state) {
    (void)state;
    lensprof_camera camera = plain_camera(LENSPROF_PROJECTION_RECTILINEAR, 90);
    camera.radial[0] = 0.01;
    camera.radial[1] = -0.03;
    camera.radial[2] = 0.05;
    camera.shift_px[0] = 12;
    camera.shift_px[1] = -7;
    camera.shear_px[0] = 8;
    camera.shear_px[1] = -24;
    double r = 0.75, factor = 0.01 * r * r * r - 0.03 * r * r + 0.05 * r + 0.97;
    double x = 300 * factor + 12, y = -7;
    assert_pixel(&camera, atan(0.5), 0, x + 8.0 / 800 * y + 599.5, y - 24.0 / 1200 * x + 399.5);
}

static void test_limits_of_sight(void **state) {
    (void)state;
    double direction[2] = {3, 4};
    lensprof_camera camera = plain_camera(LENSPROF_PROJECTION_RECTILINEAR, 90);
    assert_unseen(&camera, 90.001 * DEGREE, 0);
    assert_unseen(&camera, PI, 0);
    assert_unseen(&camera, NAN, 0);
    assert_int_equal(lensprof_camera_unproject(&camera, NAN, 0, direction), 0);
    camera = plain_camera(LENSPROF_PROJECTION_ORTHOGRAPHIC, 180);
    assert_unseen(&camera, 90.001 * DEGREE, 0);
    assert_int_equal(lensprof_camera_unproject(&camera, 1200.5, 399.5, direction), 0);
    camera = plain_camera(LENSPROF_PROJECTION_THOBY, 180);
    assert_unseen(&camera, 127 * DEGREE, 0);
    camera = plain_camera(LENSPROF_PROJECTION_STEREOGRAPHIC, 180);
    assert_unseen(&camera, PI, 0);
    camera = plain_camera(LENSPROF_PROJECTION_EQUISOLID, 360);
    assert_int_equal(lensprof_camera_unproject(&camera, 1200.5, 399.5, direction), 0);
    camera = plain_camera(LENSPROF_PROJECTION_CIRCULAR_FISHEYE, 360);
    assert_int_equal(lensprof_camera_unproject(&camera, 1200.5, 399.5, direction), 0);
    camera = plain_camera(LENSPROF_PROJECTION_EQUIRECTANGULAR, 360);
    assert_int_equal(lensprof_camera_unproject(&camera, 599.5, 399.5 + 301, direction), 0);
    assert_int_equal(lensprof_camera_unproject(&camera, 1201, 399.5, direction), 0);
    camera = plain_camera(LENSPROF_PROJECTION_CYLINDRICAL, 360);
    assert_unseen(&camera, 0, -INFINITY);
    assert_true(direction[0] == 3 && direction[1] == 4);
}

/* P = R (1.3 - 0.3 R^2) turns back at 1.3 = 0.9 R^2; b alone and c alone likewise. */
static void test_radial_turns_back(void **state) {
    (void)state;
    const double radial[3][3] = {{0, -0.3, 0}, {0, 0, -0.4}, {-0.1, 0, 0}};
    const double turn[3] = {sqrt(1.3 / 0.9), 1.4 / 0.8, cbrt(1.1 / 0.4)};
    for (int i = 0; i < 3; i++) {
        lensprof_camera camera = plain_camera(LENSPROF_PROJECTION_CIRCULAR_FISHEYE, 180);
        memcpy(camera.radial, radial[i], sizeof camera.radial);
        double per_angle = 1200 / PI, rim = turn[i] * 400 / per_angle, direction[2], xy[2];
        assert_unseen(&camera, rim * 1.000001, 0);
        assert_int_equal(lensprof_camera_project(&camera, rim * 0.999999, 0, xy), 1);
        assert_int_equal(lensprof_camera_unproject(&camera, xy[0], xy[1], direction), 1);
        assert_close(direction[0], rim * 0.999999, 1e-9);
        assert_int_equal(lensprof_camera_unproject(&camera, xy[0] + 0.001, xy[1], direction), 0);
    }
}

static lensprof_camera random_camera(uint32_t projection, uint64_t *seed) {
    double widest = projection == LENSPROF_PROJECTION_RECTILINEAR    ? 130
                    : projection == LENSPROF_PROJECTION_THOBY        ? 250
                    : projection == LENSPROF_PROJECTION_ORTHOGRAPHIC ? 180
                                                                     : 340;
    lensprof_camera camera = {.projection = projection};
    camera.width = 100 + (uint32_t)(5000 * lp_random(seed));
    camera.height = 100 + (uint32_t)(5000 * lp_random(seed));
    camera.hfov_deg = 5 + (widest - 5) * lp_random(seed);
    camera.yaw_deg = 720 * (lp_random(seed) - 0.5);
    camera.pitch_deg = 360 * (lp_random(seed) - 0.5);
    camera.roll_deg = 720 * (lp_random(seed) - 0.5);
    int parts = (int)(8 * lp_random(seed)); /* every combination of radial, shift and shear, translation */
    for (int i = 0; i < 3; i++) {
        camera.radial[i] = parts & 1 ? 0.3 * (lp_random(seed) - 0.5) : 0;
        camera.translation[i] = parts & 4 ? 1.2 * (lp_random(seed) - 0.5) : 0;
    }
    for (int i = 0; i < 2; i++) {
        camera.shift_px[i] = parts & 2 ? 100 * (lp_random(seed) - 0.5) : 0;
        camera.shear_px[i] = parts & 2 ? 60 * (lp_random(seed) - 0.5) : 0;
        camera.plane_deg[i] = parts & 4 ? 120 * (lp_random(seed) - 0.5) : 0;
    }
    return camera;
}

/* Every pixel with a direction comes back. There is no direction outside the image circle or beyond the plane. */
static void test_round_trip(void **state) {
    (void)state;
    uint64_t seed = 20070627;
    for (size_t i = 0; i < LENSES; i++) {
        int seen = 0, tried = 0;
        for (int camera_number = 0; camera_number < 400; camera_number++) {
            lensprof_camera camera = random_camera(lenses[i], &seed);
            if (lensprof_camera_validate(&camera) != LENSPROF_OK) {
                continue;
            }
            for (int point = 0; point < 25; point++) {
                double x = camera.width * (1.2 * lp_random(&seed) - 0.1), direction[2];
                double y = camera.height * (1.2 * lp_random(&seed) - 0.1), back[2];
                tried++;
                if (lensprof_camera_unproject(&camera, x, y, direction)) {
                    seen++;
                    assert_int_equal(lensprof_camera_project(&camera, direction[0], direction[1], back), 1);
                    assert_close(back[0], x, 1e-9);
                    assert_close(back[1], y, 1e-9);
                }
            }
        }
        print_message("lens %u: %d of %d pixels have a direction\n", lenses[i], seen, tried);
        assert_true(seen > tried / 3);
    }
}

/* The reverse: projecting a direction and back gives that direction. */
static void test_round_trip_of_directions(void **state) {
    (void)state;
    uint64_t seed = 5;
    for (size_t i = 0; i < LENSES; i++) {
        int seen = 0;
        for (int n = 0; n < 10000; n++) {
            lensprof_camera camera = random_camera(lenses[i], &seed);
            double longitude = PI * (2 * lp_random(&seed) - 1), latitude = asin(2 * lp_random(&seed) - 1);
            double xy[2], direction[2];
            if (lensprof_camera_validate(&camera) != LENSPROF_OK
                || !lensprof_camera_project(&camera, longitude, latitude, xy) || fabs(xy[0]) > 2e4 || fabs(xy[1]) > 2e4
                || !lensprof_camera_unproject(&camera, xy[0], xy[1], direction)) {
                continue;
            }
            seen++;
            double apart = hypot(sin(latitude - direction[1]), cos(latitude) * sin(longitude - direction[0]));
            assert_close(apart, 0, 1e-6); /* at the rim all pixels have nearly the same direction */
        }
        assert_true(seen > 2000);
    }
}

static void assert_invalid(lensprof_camera camera) {
    assert_int_equal(lensprof_camera_validate(&camera), LENSPROF_ERROR_GEOMETRY);
}

#define INVALID(base, change)       \
    do {                            \
        lensprof_camera c = (base); \
        c.change;                   \
        assert_invalid(c);          \
    } while (0)

static void test_validate(void **state) {
    (void)state;
    assert_int_equal(lensprof_camera_validate(NULL), LENSPROF_ERROR_ARGUMENT);
    lensprof_camera good = plain_camera(LENSPROF_PROJECTION_RECTILINEAR, 179.9);
    INVALID(good, projection = 5);
    INVALID(good, projection = UINT32_MAX);
    INVALID(good, width = 0);
    INVALID(good, height = 0);
    INVALID(good, width = (1u << 20) + 1);
    INVALID(good, height = (1u << 20) + 1);
    INVALID(good, hfov_deg = 0);
    INVALID(good, hfov_deg = -20);
    INVALID(good, hfov_deg = 180);
    INVALID(good, hfov_deg = NAN);
    INVALID(good, yaw_deg = INFINITY);
    INVALID(good, pitch_deg = NAN);
    INVALID(good, roll_deg = NAN);
    INVALID(good, radial[2] = NAN);
    INVALID(good, radial[1] = 1);
    INVALID(good, shift_px[1] = INFINITY);
    INVALID(good, shear_px[0] = NAN);
    INVALID(good, translation[2] = NAN);
    INVALID(good, translation[2] = -1); /* lies on the remapping plane */
    INVALID(good, plane_deg[1] = NAN);
    good.width = good.height = 1u << 20;
    assert_ok(lensprof_camera_validate(&good));
    good.shear_px[0] = good.shear_px[1] = 1u << 20; /* both axes coincide */
    assert_invalid(good);
}

static void test_validate_field_of_view(void **state) {
    (void)state;
    const double widest[LENSES] = {179.99, 360, 3600, 3600, 360, 360, 359.99, 252.4, 360};
    const double too_wide[LENSES] = {180, 360.01, 3600.01, 3600.01, 360.01, 360.01, 360, 252.5, 360.01};
    for (size_t i = 0; i < LENSES; i++) {
        lensprof_camera camera = plain_camera(lenses[i], widest[i]);
        INVALID(camera, hfov_deg = too_wide[i]);
    }
    /* A fisheye whose frame is wider than 360 degrees: the angle stays proportional to the radius, up to 180. */
    for (int i = 2; i <= 3; i++) {
        const lensprof_camera camera = plain_camera(lenses[i], 400);
        const double middle = (camera.width - 1) / 2.0, side = 90 * camera.width / 400.0;
        double xy[2], direction[2];
        assert_int_equal(lensprof_camera_project(&camera, acos(-1) / 2, 0, xy), 1);
        assert_close(xy[0], middle + side, 1e-9);
        assert_int_equal(lensprof_camera_unproject(&camera, middle + 1.99 * side, (camera.height - 1) / 2.0, direction),
                         1);
        assert_int_equal(lensprof_camera_unproject(&camera, middle + 2.01 * side, (camera.height - 1) / 2.0, direction),
                         0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_centre_and_edges),
        cmocka_unit_test(test_lens_formulas),
        cmocka_unit_test(test_rotation),
        cmocka_unit_test(test_translation),
        cmocka_unit_test(test_distortion_shift_and_shear),
        cmocka_unit_test(test_limits_of_sight),
        cmocka_unit_test(test_radial_turns_back),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_round_trip_of_directions),
        cmocka_unit_test(test_validate),
        cmocka_unit_test(test_validate_field_of_view),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
