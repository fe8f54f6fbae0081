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
                const Profile truth = lens(channels);
                const uint32_t rows = columns * 3 / 4;
                const std::vector<float> values = write(*truth, columns, rows, channels, sense);
                const float edge = sense ? *std::min_element(values.begin(), values.end())
                                         : *std::max_element(values.begin(), values.end());
                assert_true(edge == 1.0f);
                const lensprof_map map = {columns, rows, channels, sense, values.data()};
                Profile found = full_profile();
                double worst = 99;
                assert_ok(lensprof_map_read(&map, kWidth, kHeight, found.get(), &worst, nullptr));
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
    assert_ok(lensprof_map_read(&map, kWidth, kHeight, found.get(), nullptr, nullptr));
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
    assert_ok(lensprof_map_read(&map, kWidth, kHeight, found.get(), &worst, nullptr));
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
        assert_ok(lensprof_map_read(&map, kWidth, kHeight, found.get(), nullptr, nullptr));
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

void test_refused(void **) {
    std::vector<float> values(64 * 48, 1.0f);
    lensprof_map map = {64, 48, 1, 0, values.data()};
    Profile found = full_profile();
    const Profile before = copy_of(*found);
    lensprof_error error;
    const auto read = [&](lensprof_status status, const char *words) {
        assert_int_equal(lensprof_map_read(&map, kWidth, kHeight, found.get(), nullptr, &error), status);
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
        cmocka_unit_test(test_round_trip), cmocka_unit_test(test_coded), cmocka_unit_test(test_grid),
        cmocka_unit_test(test_narrow),     cmocka_unit_test(test_mean),  cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
