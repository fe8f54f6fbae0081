// Refitting falloffs of other shapes to the polynomial: exact for polynomials, approximate for other shapes, refused if
// impossible.
#include <cmath>
#include <memory>

#include <lensprof/formats.h>

#include "falloff/map_fit.hpp"
#include "falloff/refit.hpp"
#include "formats/text/text.hpp"

extern "C" {
#include "support.h"
}

using namespace lensprof;

namespace {

lensprof_status status_of(const std::function<void()> &body) { return at_boundary(nullptr, body); }

double polynomial(double r2) { return 1.0 - 0.5 * r2 + 0.2 * r2 * r2 - 0.1 * r2 * r2 * r2; }

void test_radial_exact(void **) {
    const RadialRefit refit = refit_radial([](double r2) { return 3.0 * polynomial(r2); });
    assert_true(std::fabs(refit.k[0] + 0.5) < 1e-12 && std::fabs(refit.k[1] - 0.2) < 1e-11);
    assert_true(std::fabs(refit.k[2] + 0.1) < 1e-11 && refit.worst < 1e-12);
}

// One and two stops of cos^4: the truncated series 1 - a1 r^2 + (a1^2 - a2) r^4 - ... is off by 3 to 44 %.
void test_radial_reciprocal(void **) {
    for (const double corner : {0.5, 0.25}) {
        const double tan2 = 1.0 / std::sqrt(corner) - 1.0;
        const RadialRefit refit = refit_radial([=](double r2) { return 1.0 / std::pow(1.0 + tan2 * r2, 2); });
        assert_true(refit.worst < (corner < 0.3 ? 0.02 : 0.002));
    }
}

void test_radial_refused(void **) {
    assert_int_equal(status_of([] { refit_radial([](double r2) { return 1.0 - 1.2 * r2; }); }),
                     LENSPROF_ERROR_VIGNETTING);
    assert_int_equal(status_of([] { refit_radial([](double r2) { return r2 > 0.5 ? NAN : 1.0; }); }),
                     LENSPROF_ERROR_NOT_FINITE);
}

FalloffMap map_of(const lensprof_profile &profile, uint32_t columns, uint32_t rows, uint32_t channels, double scale) {
    FalloffMap map{6000, 4000, columns, rows, channels, 0, 0, 0, 0, {}};
    place_as_cells(map);
    for (uint32_t c = 0; c < channels; c++)
        for (uint32_t j = 0; j < rows; j++)
            for (uint32_t i = 0; i < columns; i++)
                map.attenuation.push_back(scale * (c + 1)
                                          * lensprof_profile_falloff(&profile, c, map.width, map.height,
                                                                     map.x0 + i * map.dx, map.y0 + j * map.dy,
                                                                     nullptr));
    return map;
}

std::unique_ptr<lensprof_profile> lens_profile(uint32_t curves) {
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    profile->vignettings = curves;
    for (uint32_t c = 0; c < curves; c++) profile->vignetting[c] = {{-0.5 - 0.05 * c, 0.2, -0.1}, {0.06, -0.04}};
    return profile;
}

void test_map_exact(void **) {
    for (const uint32_t curves : {1u, 3u}) {
        const auto truth = lens_profile(curves);
        auto found = std::make_unique<lensprof_profile>();
        lensprof_profile_init(found.get());
        assert_true(fit_map(map_of(*truth, 300, 200, curves, 7.0), *found) < 1e-9);
        assert_int_equal(found->vignettings, curves);
        assert_int_equal(found->grid.columns, 0);
        for (uint32_t c = 0; c < curves; c++) {
            for (int n = 0; n < 3; n++)
                assert_true(std::fabs(found->vignetting[c].k[n] - truth->vignetting[c].k[n]) < 1e-7);
            assert_true(std::fabs(found->vignetting[c].center[0] - 0.06) < 1e-7);
            assert_true(std::fabs(found->vignetting[c].center[1] + 0.04) < 1e-7);
        }
        assert_int_equal(lensprof_profile_validate(found.get()), LENSPROF_OK);
    }
}

// A tilt, which is not radial, goes into the grid; places outside the lens's circle (0) are ignored.
void test_map_with_grid(void **) {
    const auto truth = lens_profile(1);
    FalloffMap map = map_of(*truth, 600, 400, 1, 1.0);
    for (uint32_t j = 0; j < map.rows; j++)
        for (uint32_t i = 0; i < map.columns; i++) {
            const double x = i / 599.0 - 0.5, y = j / 399.0 - 0.5;
            double &value = map.attenuation[size_t(j) * map.columns + i];
            value *= 1.0 + 0.1 * std::sin(5.0 * x) * std::cos(4.0 * y);
            if (std::hypot(x, y) > 0.68) value = 0.0;
        }
    auto found = std::make_unique<lensprof_profile>();
    lensprof_profile_init(found.get());
    assert_true(fit_map(map, *found) < 0.003);
    assert_int_equal(found->grid.columns, 24);
    assert_int_equal(found->grid.rows, 16);
    assert_int_equal(lensprof_profile_validate(found.get()), LENSPROF_OK);
}

// A table with as many values as nodes is reproduced, not smoothed.
void test_map_of_few(void **) {
    FalloffMap map = map_of(*lens_profile(3), 16, 12, 3, 1.0);
    for (size_t i = 0; i < map.attenuation.size(); i++)
        map.attenuation[i] *= 1.0 + 0.05 * std::sin(0.9 * double(i % 16)) * std::cos(0.8 * double(i / 16));
    auto found = std::make_unique<lensprof_profile>();
    lensprof_profile_init(found.get());
    assert_true(fit_map(map, *found) < 0.005);
    assert_int_equal(found->grid.columns, 16);
    assert_int_equal(lensprof_profile_validate(found.get()), LENSPROF_OK);
}

void test_map_refused(void **) {
    auto found = std::make_unique<lensprof_profile>();
    lensprof_profile_init(found.get());
    const auto fit = [&](FalloffMap map) { return status_of([&] { fit_map(map, *found); }); };
    FalloffMap map = map_of(*lens_profile(1), 16, 12, 1, 1.0);
    FalloffMap bad = map;
    bad.attenuation[5] = NAN;
    assert_int_equal(fit(bad), LENSPROF_ERROR_NOT_FINITE);
    for (double &value : bad.attenuation) value = 0.0;
    assert_int_equal(fit(bad), LENSPROF_ERROR_VIGNETTING);
    bad.attenuation[0] = 1.0;
    assert_int_equal(fit(bad), LENSPROF_ERROR_VIGNETTING);
    assert_int_equal(fit(map), LENSPROF_OK);
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_radial_exact),   cmocka_unit_test(test_radial_reciprocal),
        cmocka_unit_test(test_radial_refused), cmocka_unit_test(test_map_exact),
        cmocka_unit_test(test_map_with_grid),  cmocka_unit_test(test_map_of_few),
        cmocka_unit_test(test_map_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
