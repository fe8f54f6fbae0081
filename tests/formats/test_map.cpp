// Falloffs as maps: DSO's vignette.png, gain images.
#include <algorithm>

#include "profile_support.hpp"

namespace {

constexpr uint32_t kWidth = 640, kHeight = 480;

Profile lens(uint32_t curves) {
    Profile profile = new_profile();
    profile->vignettings = curves;
    for (uint32_t c = 0; c < curves; c++) profile->vignetting[c] = {{-0.5 - 0.05 * c, 0.2, -0.1}, {0.05, -0.03}};
    return profile;
}

std::vector<float> write(const lensprof_profile &profile, uint32_t columns, uint32_t rows, uint32_t channels,
                         uint32_t sense) {
    std::vector<float> values(size_t(columns) * rows * channels);
    assert_ok(lensprof_map_write(&profile, kWidth, kHeight, columns, rows, channels, sense, values.data(), nullptr));
    return values;
}

double worst_beside(const lensprof_profile &a, const lensprof_profile &b) {
    const std::vector<float> x = write(a, 64, 48, 3, 0), y = write(b, 64, 48, 3, 0);
    double worst = 0;
    for (size_t i = 0; i < x.size(); i++) worst = fmax(worst, fabs(double(x[i]) / double(y[i]) - 1));
    return worst;
}

// Both senses, a reduced map and one at full resolution, one channel and three.
void test_round_trip(void **) {
    for (const uint32_t channels : {1u, 3u})
        for (const uint32_t sense : {0u, 1u})
            for (const uint32_t columns : {32u, 640u, 2560u}) {
                if (columns == 2560u && channels != 1 + 2 * sense) continue;  // takes seconds under sanitizers
                const Profile truth = lens(channels);
                const uint32_t rows = columns * 3 / 4;
                const std::vector<float> values = write(*truth, columns, rows, channels, sense);
                const float edge = sense ? *std::min_element(values.begin(), values.end())
                                         : *std::max_element(values.begin(), values.end());
                assert_true(edge == 1.0f);
                const lensprof_map map = {columns, rows, channels, sense, values.data()};
                Profile found = full_profile();
                double worst = 99;
                assert_ok(lp_map_read(&map, kWidth, kHeight, found.get(), &worst, nullptr));
                assert_true(worst < 1e-6);
                assert_int_equal(found->vignettings, channels);
                assert_int_equal(found->grid.columns, 0);
                assert_int_equal(found->covariance_size, 0);
                assert_string_equal(found->key.lens, "50mm f/1.8");
                assert_ok(lensprof_profile_validate(found.get()));
                for (uint32_t c = 0; c < channels; c++)
                    for (int n = 0; n < 3; n++)
                        assert_close(found->vignetting[c].k[n], truth->vignetting[c].k[n], 1e-4);
                assert_close(found->vignetting[0].center[0], 0.05, 1e-5);
            }
}

// 8 bit values as in vignette.png add only the noise of rounding.
void test_coded(void **) {
    const Profile truth = lens(1);
    std::vector<float> values = write(*truth, kWidth, kHeight, 1, 0);
    for (float &value : values) value = roundf(value * 255);
    const lensprof_map map = {kWidth, kHeight, 1, 0, values.data()};
    Profile found = new_profile();
    assert_ok(lp_map_read(&map, kWidth, kHeight, found.get(), nullptr, nullptr));
    assert_true(worst_beside(*found, *truth) < 1e-3);
}

// A tilt becomes a gain grid, which is written again; unknown values (0) are ignored.
void test_grid(void **) {
    const Profile truth = lens(3);
    std::vector<float> values = write(*truth, kWidth, kHeight, 3, 1);
    for (uint32_t j = 0; j < kHeight; j++)
        for (uint32_t i = 0; i < kWidth; i++)
            for (uint32_t c = 0; c < 3; c++) {
                float &value = values[(size_t(j) * kWidth + i) * 3 + c];
                value *= 1 + 0.1f * sinf(float(i) / 100) * cosf(float(j) / 90 + float(c));
                if (i < 30 && j < 30) value = 0;
            }
    const lensprof_map map = {kWidth, kHeight, 3, 1, values.data()};
    Profile found = new_profile();
    double worst;
    assert_ok(lp_map_read(&map, kWidth, kHeight, found.get(), &worst, nullptr));
    assert_true(worst < 0.006);
    assert_int_equal(found->grid.channels, 3);
    const std::vector<float> again = write(*found, kWidth, kHeight, 3, 1);
    const size_t at = (size_t(200) * kWidth + 300) * 3;
    assert_close(again[at] / again[at + 300], values[at] / values[at + 300], 0.01);
}

// Maps with few rows and many columns, or the reverse; the long direction is averaged.
void test_narrow(void **) {
    const Profile truth = lens(1);
    const uint32_t shapes[][2] = {{60000, 2}, {2100, 2}, {2, 5000}, {5000, 4}};
    for (const auto &shape : shapes) {
        const std::vector<float> values = write(*truth, shape[0], shape[1], 1, 0);
        const lensprof_map map = {shape[0], shape[1], 1, 0, values.data()};
        Profile found = new_profile();
        assert_ok(lp_map_read(&map, kWidth, kHeight, found.get(), nullptr, nullptr));
        assert_true(worst_beside(*found, *truth) < 0.02);
    }
}

// Writing one channel from three curves gives their mean.
void test_mean(void **) {
    const Profile truth = lens(3);
    const std::vector<float> one = write(*truth, 20, 15, 1, 0), all = write(*truth, 20, 15, 3, 0);
    for (size_t i = 0; i < one.size(); i++) {
        const double mean = (double(all[3 * i]) + double(all[3 * i + 1]) + double(all[3 * i + 2])) / 3;
        assert_close(double(one[i]) / double(one[150]),
                     mean / ((double(all[450]) + double(all[451]) + double(all[452])) / 3), 1e-6);
    }
}

// A map of a fisheye: M inside a circle, and dark, blurred or noisy outside of it.
struct FisheyeMap {
    uint32_t width, height, channels;
    double k[3], x, y, radius;  // centre in px, radius in half diagonals
    double full;                // of the values
    double noise;               // of what is dark, levels
    double blur;                // px, of the edge
    bool is_rectangle;          // half as high as wide instead of a circle
};

double distance_of(const FisheyeMap &map, double x, double y) {
    return hypot(x - map.x, y - map.y) / (hypot(map.width, map.height) / 2);
}

double falloff_of(const FisheyeMap &map, double r) {
    return 1 + r * r * (map.k[0] + r * r * (map.k[1] + r * r * map.k[2]));
}

// How far a place is inside, px.
double depth_of(const FisheyeMap &map, double x, double y) {
    const double side = map.radius * hypot(map.width, map.height) / 2;
    if (map.is_rectangle) return fmin(side - fabs(x - map.x), side / 2 - fabs(y - map.y));
    return side - hypot(x - map.x, y - map.y);
}

std::vector<float> values_of(const FisheyeMap &map) {
    std::vector<float> values;
    uint64_t random = 3;
    for (uint32_t y = 0; y < map.height; y++)
        for (uint32_t x = 0; x < map.width; x++)
            for (uint32_t c = 0; c < map.channels; c++) {
                const double depth = depth_of(map, x, y), dark = map.noise * lp_random(&random);
                const double share = map.blur > 0 ? fmin(fmax(0.5 + depth / map.blur, 0), 1) : depth > 0;
                const double light = share > 0 ? share * falloff_of(map, distance_of(map, x, y)) * map.full : 0;
                values.push_back(roundf(static_cast<float>(fmax(light, dark))));
            }
    return values;
}

// The falloff inside is that of the formula, within 1 %; outside it stays within what the inside has; the circle is
// kept.
void test_fisheye(void **) {
    const FisheyeMap maps[] = {
        {424, 400, 1, {-.05, -.6, -1.2}, 213, 203, .60, 65535, 0, 0, false},
        {424, 400, 1, {-.05, -.6, -1.2}, 213, 203, .60, 255, 0, 0, false},
        {424, 400, 1, {-.05, -.6, -1.2}, 190, 215, .55, 255, 5, 0, false},
        {424, 400, 3, {-.3, -.9, -1.5}, 213, 203, .58, 255, 5, 3, false},
        {400, 640, 1, {-.4, 0, -2.2}, 199.5, 319.5, .52, 65535, 300, 2, false},
        {1280, 960, 1, {-.2, -.2, -1.9}, 600, 500, .60, 255, 4, 4, false},
        {1920, 1080, 1, {-.9, .1, 0}, 959.5, 539.5, .49, 65535, 0, 0, false},
        {640, 480, 1, {-.3, 0, -.4}, 330, 250, .77, 255, 2, 0, false},  // cut by the upper and lower edge
        {640, 480, 1, {-.3, -.2, -.4}, 319.5, 239.5, .70, 255, 3, 2, true},
    };
    for (const FisheyeMap &map : maps) {
        const std::vector<float> values = values_of(map);
        const lensprof_map read = {map.width, map.height, map.channels, 0, values.data()};
        Profile found = new_profile();
        lensprof_error error;
        double worst = 99;
        const lensprof_status status = lp_map_read(&read, map.width, map.height, found.get(), &worst, &error);
        if (status != LENSPROF_OK) fail_msg("radius %g: %s", map.radius, error.text);
        assert_ok(lensprof_profile_validate(found.get()));
        const lensprof_image_circle circle = found->image_circle;
        found->image_circle = {};  // of the continued falloff
        const auto at = [&](double x, double y) {
            return lensprof_profile_falloff(found.get(), 1, map.width, map.height, x, y, nullptr);
        };
        double most = 0, lowest = 1;
        for (uint32_t y = 0; y < map.height; y += 7)
            for (uint32_t x = 0; x < map.width; x += 7) {
                const double m = falloff_of(map, distance_of(map, x, y));
                if (depth_of(map, x, y) > 5 + 1.5 * map.blur + map.width / 150.0) {
                    most = fmax(most, fabs(at(x, y) / at(map.x, map.y) / m - 1));
                    lowest = fmin(lowest, m);
                }
            }
        if (most > (map.full == 255 ? .012 : .01)) fail_msg("radius %g: off by %g", map.radius, most);
        for (uint32_t y = 0; y < map.height; y += 7)
            for (uint32_t x = 0; x < map.width; x += 7) {
                const double m = at(x, y) / at(map.x, map.y);
                if (m < .7 * lowest || m > 1.1) fail_msg("radius %g: %g outside of it", map.radius, m);
            }
        if (map.is_rectangle) {
            assert_true(circle.radius == 0);
            continue;
        }
        const double half = hypot(map.width, map.height) / 2;
        assert_close(circle.radius, map.radius, 0.008);
        assert_close(circle.center[0], (map.x - (map.width - 1) / 2.0) / half, 0.006);
        assert_close(circle.center[1], (map.y - (map.height - 1) / 2.0) / half, 0.006);
    }
}

// A lens that is nearly dark in the corners has no edge there, and specks are not a surround.
void test_dark_corners_are_known(void **) {
    std::vector<float> values;
    for (uint32_t y = 0; y < kHeight; y++)
        for (uint32_t x = 0; x < kWidth; x++) {
            const double r = hypot(x - 319.5, y - 239.5) / 400;
            values.push_back(static_cast<float>(exp2(-6 * r * r)));
        }
    values[100 * kWidth + 100] = 0;
    const lensprof_map map = {kWidth, kHeight, 1, 0, values.data()};
    Profile found = new_profile();
    assert_ok(lp_map_read(&map, kWidth, kHeight, found.get(), nullptr, nullptr));
    assert_null(strstr(found->provenance.source, "valid"));
    const auto at = [&](double x, double y) {
        return lensprof_profile_falloff(found.get(), 1, kWidth, kHeight, x, y, nullptr);
    };
    assert_true(at(4, 3) / at(319.5, 239.5) < .03);  // of 2^-6, and not what is left at an edge of .05
}

// Parts of a map without data are refused unless they are outside of a circle or the margin of a rectangle; dead pixels
// are not.
void test_holes(void **) {
    struct Shape {
        const char *name;
        uint32_t width, height, channels;
        bool (*is_hole)(double x, double y, uint32_t channel);  // x and y: 0 to 1
        const char *share;                                      // refused with it; null: read
    };
    const Shape shapes[] = {
        {"left third", 640, 480, 1, [](double x, double, uint32_t) { return x < 1 / 3.; }, "33.3 % of the frame"},
        {"left third of a small one", 30, 20, 1, [](double x, double, uint32_t) { return x < 1 / 3.; }, "33.3 %"},
        {"lower fifth", 120, 160, 3, [](double, double y, uint32_t) { return y > .8; }, "20.0 %"},
        {"corner", 160, 120, 1, [](double x, double y, uint32_t) { return x > .8 && y > .8; }, "4.0 %"},
        {"middle", 640, 480, 1, [](double x, double y, uint32_t) { return hypot(x - .5, y - .5) < .15; }, "7.1 %"},
        {"middle of a small one", 40, 40, 1,
         [](double x, double y, uint32_t) { return fmax(fabs(x - .5), fabs(y - .5)) < .1; }, "4.0 %"},
        {"two halves", 160, 120, 1, [](double x, double, uint32_t) { return fabs(x - .5) < .02; }, "3.8 %"},
        {"blue", 160, 120, 3, [](double x, double, uint32_t c) { return x > .75 && c == 2; }, "25.0 %"},
        {"every tenth", 640, 480, 1, [](double x, double, uint32_t) { return int(x * 640) % 10 == 0; }, "10.0 %"},
        {"circle with a hole", 600, 600, 1,
         [](double x, double y, uint32_t) { return hypot(x - .5, y - .5) > .45 || hypot(x - .6, y - .4) < .1; },
         "39.5 %"},
        {"sector of a circle", 600, 600, 1,
         [](double x, double y, uint32_t) { return hypot(x - .5, y - .5) > .45 || (x < .5 && y < .5); }, "52.3 %"},
        {"small circle", 40, 40, 1, [](double x, double y, uint32_t) { return hypot(x - .5, y - .5) > .45; }, nullptr},
        {"bands", 160, 120, 1, [](double, double y, uint32_t) { return fabs(y - .5) > .4; }, nullptr},
        {"border", 640, 480, 1, [](double x, double, uint32_t) { return x < .03; }, nullptr},
        {"dead pixels", 640, 480, 3,
         [](double x, double y, uint32_t c) { return (int(x * 640) * 7 + int(y * 480) * 31) % 997 == int(c); },
         nullptr},
    };
    for (const Shape &shape : shapes) {
        std::vector<float> values;
        for (uint32_t y = 0; y < shape.height; y++)
            for (uint32_t x = 0; x < shape.width; x++)
                for (uint32_t c = 0; c < shape.channels; c++) {
                    const double r2 = 4 * (pow(x - (shape.width - 1) / 2., 2) + pow(y - (shape.height - 1) / 2., 2))
                                      / (pow(shape.width, 2) + pow(shape.height, 2));
                    const bool is_hole = shape.is_hole((x + .5) / shape.width, (y + .5) / shape.height, c);
                    values.push_back(is_hole ? 0 : static_cast<float>(1 - .4 * r2));
                }
        const lensprof_map map = {shape.width, shape.height, shape.channels, 0, values.data()};
        Profile found = new_profile();
        lensprof_error error = {};
        const lensprof_status status = lp_map_read(&map, shape.width, shape.height, found.get(), nullptr, &error);
        if (status != (shape.share ? LENSPROF_ERROR_VIGNETTING : LENSPROF_OK)
            || (shape.share && !strstr(error.text, shape.share)))
            fail_msg("%s: status %d, \"%s\"", shape.name, int(status), error.text);
    }
}

void test_refused(void **) {
    std::vector<float> values(64 * 48, 1.0f);
    lensprof_map map = {64, 48, 1, 0, values.data()};
    Profile found = full_profile();
    const Profile before = copy_of(*found);
    lensprof_error error;
    const auto read = [&](lensprof_status status, const char *words) {
        assert_int_equal(lp_map_read(&map, kWidth, kHeight, found.get(), nullptr, &error), status);
        if (!strstr(error.text, words)) fail_msg("\"%s\" instead of \"%s\"", error.text, words);
        assert_memory_equal(found.get(), before.get(), sizeof *before);
    };
    values[64 + 2] = NAN;
    read(LENSPROF_ERROR_NOT_FINITE, "column 2, row 1 is not finite");
    values[64 + 2] = -1;
    read(LENSPROF_ERROR_ARGUMENT, "column 2, row 1 is below 0");
    std::fill(values.begin(), values.end(), 0.0f);
    read(LENSPROF_ERROR_VIGNETTING, "no value above 0");
    values[3] = 1;
    read(LENSPROF_ERROR_VIGNETTING, "too few values");
    map.columns = 1;
    read(LENSPROF_ERROR_SIZE, "1 x 48");
    map.columns = 70000;
    read(LENSPROF_ERROR_SIZE, "70000 x 48");
    map.columns = 64, map.channels = 2;
    read(LENSPROF_ERROR_ARGUMENT, "1 or 3 channels");
    map.channels = 1, map.sense = 2;
    read(LENSPROF_ERROR_ARGUMENT, "known sense");
    map.sense = 0, map.values = nullptr;
    read(LENSPROF_ERROR_ARGUMENT, "values");
    assert_int_equal(lensprof_map_write(found.get(), 0, 5, 5, 5, 1, 0, values.data(), nullptr), LENSPROF_ERROR_SIZE);
    assert_int_equal(lensprof_map_write(found.get(), 5, 5, 5, 5, 2, 0, values.data(), nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_map_write(found.get(), 5, 5, 5, 5, 1, 2, values.data(), nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    found->vignetting[0].k[0] = -9;
    assert_int_equal(lensprof_map_write(found.get(), 5, 5, 5, 5, 1, 0, values.data(), nullptr),
                     LENSPROF_ERROR_VIGNETTING);
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_coded),
        cmocka_unit_test(test_grid),
        cmocka_unit_test(test_narrow),
        cmocka_unit_test(test_mean),
        cmocka_unit_test(test_fisheye),
        cmocka_unit_test(test_dark_corners_are_known),
        cmocka_unit_test(test_holes),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
