// The flat field fit on several shots: dozens of simulated pictures.
#include "flat_pictures.hpp"

// A strong falloff, off centre, far from the priors' mean.
static void the_start_does_not_matter(void **) {
    for (double k1 : {0.0, -0.3, -0.7, -1.2}) {
        FlatPictures p;
        for (auto &v : p.vignetting) v = {{k1, -0.5 * k1, 0.1 * k1}, {0.02, -0.015}};
        p.gradient[0] = 0.08;
        for (uint32_t shot = 0; shot < 3; shot++) p.shoot(shot, 0.0, 90.0 * shot);
        for (uint32_t vignettings : {1u, 3u}) {
            lensprof_flat_options o = p.options();
            o.vignettings = vignettings;
            auto r = p.fit(o);
            assert_true(r->usable);
            assert_close(error_of(*r, p), 0.0, 0.0015);
            if (k1 != 0.0) assert_close(r->vignetting[0].center[0], 0.02, 0.001);
        }
    }
}

static void a_card_at_several_places_needs_no_even_light_over_the_frame(void **) {
    FlatPictures p;
    p.set_center(0.03, -0.02);
    for (uint32_t place = 0; place < 9; place++) {
        double x0 = place % 3 * 200.0, y0 = place / 3 * 150.0;
        p.defect = [=](double x, double y, uint32_t) {
            bool card = x >= x0 && x < x0 + 200.0 && y >= y0 && y < y0 + 150.0;
            return card ? 1.0 : 0.15 + 0.1 * std::sin(0.05 * x + 0.02 * y);
        };
        p.shoot(place, place == 4 ? -0.5 : 0.0);  // exposures may differ if they are known
    }
    lensprof_flat_options o = p.options();
    o.several = o.find_card = 1;
    lensprof_flat_image_quality quality[9];
    auto r = p.fit(o, quality);
    assert_true(r->usable);
    assert_int_equal(r->separated, 1);
    assert_close(error_of(*r, p), 0.0, 0.003);
    assert_close(r->vignetting[0].center[0], 0.03, 0.003);
    for (uint32_t place = 0; place < 9; place++) {
        assert_close(quality[place].card[0], place % 3 * 200.0, 8.0);
        assert_close(quality[place].card[2], 190.0, 12.0);
        assert_close(quality[place].card[3], 136.0, 14.0);
    }
}

// Like the colour shading of a phone: stronger in one corner, and different per channel.
static double shading(double x, double y, uint32_t channel) {
    double u = x / 300 - 1, v = y / 225 - 1;
    return 1 - 0.03 * u * u * u * v - 0.02 * v * v * v + (channel == 0 ? 0.025 * u * v * v : 0.0);
}

// Pictures of a quarter of the pixels, with this power of the shading.
static FlatPictures small_shaded(double power) {
    FlatPictures p;
    p.width /= 2, p.height /= 2;
    p.defect = [power](double x, double y, uint32_t c) { return std::pow(shading(2 * x, 2 * y, c), power); };
    return p;
}

static void what_is_not_radial_goes_into_a_grid(void **) {
    FlatPictures p;
    p.defect = shading;
    for (uint32_t shot = 0; shot < 4; shot++) p.shoot(shot, 0.0, 90.0 * shot);
    auto r = p.fit(p.options());
    assert_true(r->usable);
    assert_reason(*r, FLAT_NOT_RADIAL, "grid");
    assert_true(r->frame_residual > 0.004);
    assert_true(r->grid_residual < 0.001);
    assert_int_equal(r->gain_grid.columns, 24);
    assert_int_equal(r->gain_grid.rows, 18);
    assert_ok(lensprof_gain_grid_validate(&r->gain_grid));
    double worst = 0.0, worst_without = 0.0;  // over all channels, relative to the middle of the frame
    for (uint32_t i = 0; i < 300; i++)
        for (uint32_t c = 0; c < 3; c++) {
            double x = i % 20 * 599 / 19.0, y = i / 20 * 449 / 14.0;
            auto value = [&](double px, double py, bool grid) {
                double m = lensprof_vignetting_eval(
                    &r->vignetting[c], lensprof_vignetting_r2(&r->vignetting[c], 600, 450, px, py, nullptr), nullptr);
                return m * (grid ? lensprof_gain_grid_eval(&r->gain_grid, 600, 450, px, py, c) : 1.0);
            };
            double truth = p.light(x, y, c, 0) / p.light(299.5, 224.5, c, 0);
            worst = std::fmax(worst, std::fabs(value(x, y, true) / value(299.5, 224.5, true) / truth - 1));
            worst_without =
                std::fmax(worst_without, std::fabs(value(x, y, false) / value(299.5, 224.5, false) / truth - 1));
        }
    assert_true(worst < 0.008);
    assert_true(worst_without > 4 * worst);
    lensprof_flat_options o = p.options();
    o.grid = LENSPROF_FLAT_GRID_NONE;
    r = p.fit(o);
    assert_int_equal(r->gain_grid.columns, 0);
    assert_reason(*r, FLAT_NOT_RADIAL, "request a gain grid");
}

static void what_is_far_from_radial_needs_a_grid(void **) {
    FlatPictures p = small_shaded(5.0);
    for (uint32_t shot = 0; shot < 4; shot++) p.shoot(shot, 0.0, 90.0 * shot);
    auto r = p.fit(p.options());
    assert_true(r->usable);
    assert_true(r->corner_sigma > 0.01);  // of the polynomial alone
    assert_true(r->frame_residual > 20 * r->grid_residual);
    lensprof_flat_options o = p.options();
    o.grid = LENSPROF_FLAT_GRID_NONE;
    r = p.fit(o);
    assert_false(r->usable);
    assert_reason(*r, CORNER_UNCERTAIN, "request a gain grid");
}

// If the stated angles are true, a shadow or lamp cannot leave one pattern in shots at three angles, but in those at
// two.
static void few_angles_do_not_separate_light_from_a_lens_that_is_not_radial(void **) {
    const std::vector<std::vector<double>> of_light = {{0}, {0, 90}, {0, 0, 90}, {0, 90, 90}, {0, 20, 90}},
                                           of_lens = {{0, 90, 180}, {0, 30, 60}, {0, 90, 180, 270}};
    const auto found = [](const std::vector<double> &angles, auto change) {
        FlatPictures p = small_shaded(3.0);
        for (uint32_t shot = 0; shot < angles.size(); shot++) p.shoot(shot, 0.0, angles[shot]);
        lensprof_flat_options o = p.options();
        change(o);
        const auto r = p.fit(o);
        assert_true(r->usable && r->frame_residual > 0.01);
        const lensprof_finding *finding = r->with(LENSPROF_REASON_FLAT_NOT_RADIAL);
        assert_non_null(finding);
        assert_int_equal(finding->value_count, 2);
        assert_non_null(strstr(finding->text, "gain grid"));
        return finding->severity;
    };
    const auto as_it_is = [](lensprof_flat_options &) {};
    for (const auto &angles : of_light) assert_int_equal(found(angles, as_it_is), LENSPROF_SEVERITY_WARNING);
    for (const auto &angles : of_lens) assert_int_equal(found(angles, as_it_is), LENSPROF_SEVERITY_NOTE);
    assert_int_equal(found(of_lens[0], [](auto &o) { o.free &= ~LENSPROF_FREE_CENTER; }), LENSPROF_SEVERITY_NOTE);
    assert_int_equal(found(of_light[0], [](auto &o) { o.light = LENSPROF_FLAT_LIGHT_EVEN; }), LENSPROF_SEVERITY_NOTE);
}

static void the_result_does_not_depend_on_threads(void **) {
    FlatPictures p = small_shaded(1.0);
    p.shoot(0), p.shoot(1, 0.0, 90.0);
    lensprof_flat_options o = p.options();
    o.threads = 1;
    auto one = p.fit(o);
    for (uint32_t threads : {2u, 5u, 0u}) {
        o.threads = threads;
        auto other = p.fit(o);
        assert_memory_equal(one.get(), other.get(), sizeof(lensprof_flat_result));
    }
}

static void wrong_angles_are_noticed(void **) {
    FlatPictures p;
    p.set_center(0.03, 0.0);
    p.gradient[0] = 0.12;
    p.shoot(0), p.shoot(1, 0.0, 90.0), p.shoot(2, 0.0, 180.0);
    p.images[1].rotation_deg = 270.0;
    auto r = p.fit(p.options());
    assert_false(r->usable);
    assert_reason(*r, FLAT_SHOTS_DIFFER, "angles");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_start_does_not_matter),
        cmocka_unit_test(a_card_at_several_places_needs_no_even_light_over_the_frame),
        cmocka_unit_test(what_is_not_radial_goes_into_a_grid),
        cmocka_unit_test(what_is_far_from_radial_needs_a_grid),
        cmocka_unit_test(few_angles_do_not_separate_light_from_a_lens_that_is_not_radial),
        cmocka_unit_test(the_result_does_not_depend_on_threads),
        cmocka_unit_test(wrong_angles_are_noticed),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
