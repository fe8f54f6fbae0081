// Falloffs that are not polynomials in r^2, image circles, and what one light leaves open, on simulated cards.
#include "flat_pictures.hpp"

static FlatPictures small_card(double noise_levels = 1.0) {
    FlatPictures p;
    p.width = 480, p.height = 320;
    p.noise = noise_levels / 255.0;
    return p;
}

static std::function<double(double)> law_of_the_cosine(double corner) {
    return [=](double r) { return std::pow(1.0 + (1.0 / std::sqrt(corner) - 1.0) * r * r, -2.0); };
}

// The profile of a fit can be stored.
static void assert_valid_profile(const FlatPictures &p) {
    const lensprof_flat_options o = p.options();
    lensprof_flat *flat = nullptr;
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    assert_ok(
        lensprof_fit_flat(&o, p.images.data(), static_cast<uint32_t>(p.images.size()), nullptr, 0, &flat, nullptr));
    assert_ok(lensprof_flat_profile(flat, &profile, nullptr));
    lensprof_flat_destroy(flat);
    assert_ok(lensprof_profile_validate(&profile));
}

static void up_to_six_stops_are_measured(void **) {
    const struct {
        uint32_t sample;
        double center, noise_levels, corner, worst, share;
        std::function<double(double)> falloff;
    } cards[] = {
        {LENSPROF_SAMPLE_U16, 0.0, 0.5, 0.0625, 0.004, 0.008,
         [](double r) { return std::exp2(-4.0 * std::pow(r, 2.2)); }},
        {LENSPROF_SAMPLE_F32, 0.03, 0.3, 0.016, 0.012, 0.045, law_of_the_cosine(0.016)},
        {LENSPROF_SAMPLE_U8, 0.0, 1.0, 0.0625, 0.012, 0.012, law_of_the_cosine(0.0625)},
        {LENSPROF_SAMPLE_U16, 0.02, 1.0, 0.137, 0.015, 0.03,
         [](double r) { return law_of_the_cosine(0.3)(r) / (1.0 + std::exp((r - 0.98) / 0.08)); }},
    };
    for (const auto &card : cards) {
        FlatPictures p = small_card(card.noise_levels);
        p.sample = card.sample;
        if (card.sample == LENSPROF_SAMPLE_U8) assert_ok(lensprof_response_set_gamma(&p.response, 2.2));
        p.set_falloff(card.center, 0.0, card.falloff);
        p.shoot(0);
        const auto r = p.fit(p.options());
        assert_true(r->usable);
        assert_null(r->with(LENSPROF_REASON_FLAT_TEXTURE));
        const lensprof_finding *finding = r->with(LENSPROF_REASON_FLAT_NEEDS_GRID);
        assert_non_null(finding);
        assert_int_equal(finding->severity, LENSPROF_SEVERITY_NOTE);
        assert_close(finding->value[0], r->polynomial_error, 0.0);
        assert_close(r->corner, card.corner, 0.004 + 2.0 * r->corner_sigma);
        assert_true(r->corner_sigma > 0.0 && r->corner_sigma < 0.01);
        assert_close(largest_error(*r, p), 0.0, card.worst);
        assert_close(largest_share(*r, p), 0.0, card.share);
        for (const auto &v : r->vignetting) assert_ok(lensprof_vignetting_validate(&v));
        assert_valid_profile(p);
        assert_ok(lensprof_gain_grid_validate(&r->gain_grid));
    }
}

static void without_a_grid_a_deep_falloff_is_warned_of(void **) {
    FlatPictures p = small_card();
    p.set_falloff(0.0, 0.0, law_of_the_cosine(0.2));
    p.shoot(0);
    lensprof_flat_options o = p.options();
    o.grid = LENSPROF_FLAT_GRID_NONE;
    const auto r = p.fit(o);
    assert_int_equal(r->gain_grid.columns, 0);
    assert_null(r->with(LENSPROF_REASON_FLAT_TEXTURE));
}

static void what_lies_outside_the_image_circle_is_left_out(void **) {
    const struct {
        double radius, x, share;
    } circles[] = {{0.9, 0.0, 0.06},  {0.8, 0.08, 0.2},
                   {0.55, 0.0, 0.59}, {0.8, 0.027, 0.2},   // the last: a line at the border
                   {0.95, 0.0, 0.02}, {0.97, 0.0, 0.01}};  // the last cells of the corners
    for (const auto &circle : circles) {
        FlatPictures p = small_card();
        const auto falloff = law_of_the_cosine(0.4);
        p.set_falloff(0.0, 0.0, falloff);
        p.defect = [&, inside = p.defect](double x, double y, uint32_t c) {
            const double half = 0.5 * std::hypot(480, 320);
            const double r = std::hypot((x - 239.5) / half - circle.x, (y - 159.5) / half);
            return inside(x, y, c) * (r < circle.radius ? 1.0 : 0.001);
        };
        p.shoot(0);
        const auto r = p.fit(p.options());
        assert_true(r->usable);
        const lensprof_finding *finding = r->with(LENSPROF_REASON_FLAT_EDGE);
        assert_non_null(finding);
        assert_int_equal(finding->severity, LENSPROF_SEVERITY_NOTE);
        const double tolerance = circle.radius > 0.92 ? 0.02 : 0.01;  // of few cells
        assert_close(finding->value[0], circle.radius, tolerance);
        assert_close(finding->value[1], circle.share, 0.03);
        assert_null(r->with(LENSPROF_REASON_FLAT_BLACK));
        assert_close(largest_error(*r, p, circle.radius - circle.x - 0.05), 0.0, 0.005);
        assert_close(r->corner, falloff(r->radius), 0.02);
        assert_close(r->image_circle.radius, circle.radius, tolerance);
        assert_close(r->image_circle.center[0], circle.x, 0.01);
        assert_close(r->image_circle.center[1], 0.0, 0.01);
        for (const auto &corner : {std::array<double, 2>{0, 0}, {479, 0}, {0, 319}, {479, 319}}) {  // as at the edge
            const double held = found_falloff(*r, p, corner[0], corner[1]) / falloff(r->radius);
            assert_true(held > 0.85 && held < 1.05);
        }
    }
    FlatPictures whole = small_card();
    whole.set_falloff(0.0, 0.0, law_of_the_cosine(0.016));
    whole.shoot(0);
    assert_true(whole.fit(whole.options())->edge_radius == 0.0);  // black in the corners, but without an edge
}

// Something dark at one side shows nothing of the others.
static void a_dark_strip_leaves_the_rest(void **) {
    FlatPictures p = small_card();
    const auto falloff = law_of_the_cosine(0.5);
    p.set_falloff(0.0, 0.0, falloff);
    p.defect = [inside = p.defect](double x, double y, uint32_t c) { return x < 60 ? 0.001 : inside(x, y, c); };
    p.shoot(0);
    const auto r = p.fit(p.options());
    assert_true(r->usable);
    assert_close(r->edge_radius, (239.5 - 60.0) / (0.5 * std::hypot(480, 320)), 0.02);
    assert_close(r->edge_share, 0.16, 0.03);
    assert_true(r->image_circle.radius == 0.0);  // a strip is not a circle: the falloff is continued
    assert_close(found_falloff(*r, p, 479, 0), falloff(1.0), 0.005);
}

// Nor is the border of a scan, which darkens the corners as the tips of a circle would: narrower than a cell, where
// only corners are mostly dark, or wider; on all sides, or on those that two or three corners have.
static void a_dark_border_is_no_circle(void **) {
    for (const double width : {3.0, 5.0, 9.0, 16.0, 24.0})
        for (const int sides : {15, 7, 5}) {  // left, right, top, bottom
            FlatPictures p = small_card();
            const auto falloff = law_of_the_cosine(0.5);
            p.set_falloff(0.0, 0.0, falloff);
            p.defect = [=, inside = p.defect](double x, double y, uint32_t c) {
                const double from[] = {x, 479 - x, y, 319 - y};
                bool is_border = false;
                for (int side = 0; side < 4; side++) is_border = is_border || (sides >> side & 1 && from[side] < width);
                return is_border ? 0.0001 : inside(x, y, c);
            };
            p.shoot(0);
            const auto r = p.fit(p.options());
            assert_true(r->image_circle.radius == 0.0);
            if (!r->usable) {  // cells that are dark in part are next to a corner that is not
                assert_true(sides != 15 && r->with(LENSPROF_REASON_CORNER_UNCERTAIN));
                continue;
            }
            for (const auto &[x, y] : {std::array{40.0, 40.0}, {440.0, 40.0}, {40.0, 280.0}, {240.0, 160.0}})
                assert_close(found_falloff(*r, p, x, y), falloff(radius_at(p, x, y)), 0.008);
        }
}

// A circle that cuts off the tips of corners is found in the card where a dark strip does not cover two of them.
static void a_strip_leaves_the_circle(void **) {
    for (const int clean_card : {0, 1}) {
        FlatPictures p = small_card();
        p.set_falloff(0.0, 0.0, [](double r) { return r < 0.93 ? law_of_the_cosine(0.5)(r) : 0.0001; });
        if (clean_card) p.shoot(0);
        p.defect = [clean = p.defect](double x, double y, uint32_t c) { return x < 60.0 ? 0.0001 : clean(x, y, c); };
        p.shoot(static_cast<uint32_t>(clean_card));
        const auto r = p.fit(p.options());
        assert_true(r->usable);
        assert_close(r->image_circle.radius, clean_card ? 0.93 : 0.0, 0.01);
        assert_close(found_falloff(*r, p, 240.0, 20.0), law_of_the_cosine(0.5)(radius_at(p, 240.0, 20.0)), 0.005);
    }
}

// Nor are corners that are brighter than what lies before them.
static void bright_corners_are_no_circle(void **) {
    FlatPictures p = small_card();
    p.set_falloff(0.0, 0.0, law_of_the_cosine(0.5));
    p.defect = [inside = p.defect](double x, double y, uint32_t c) {
        return inside(x, y, c) * (std::min(x, 479 - x) < 12 && std::min(y, 319 - y) < 12 ? 1.5 : 1.0);
    };
    p.shoot(0);
    assert_true(p.fit(p.options())->image_circle.radius == 0.0);
}

static void one_light_is_noted(void **) {
    FlatPictures p = small_card();
    p.shoot(0);
    const auto alone = p.fit(p.options());
    const lensprof_finding *finding = alone->with(LENSPROF_REASON_FLAT_ONE_LIGHT);
    assert_non_null(finding);
    assert_int_equal(finding->severity, LENSPROF_SEVERITY_NOTE);
    assert_non_null(strstr(finding->text, "overlapping pictures"));
    p.shoot(1);
    assert_non_null(p.fit(p.options())->with(LENSPROF_REASON_FLAT_ONE_LIGHT));
    p.shoot(2, 0.0, 90.0);
    assert_null(p.fit(p.options())->with(LENSPROF_REASON_FLAT_ONE_LIGHT));
}

// exp(-a r^2) off centre is exp(-a r^2) in the middle under a plane: only the prior separates them. Other falloffs
// differ from that.
static void the_light_is_even_where_that_describes_the_card(void **) {
    FlatPictures even = small_card();
    even.set_falloff(0.03, -0.02, [](double r) { return std::exp(-1.5 * r * r); });
    even.shoot(0);
    auto r = even.fit(even.options());
    assert_true(r->usable);
    assert_int_equal(r->light, LENSPROF_FLAT_LIGHT_EVEN);
    assert_int_equal(r->separated, 0);
    assert_close(largest_error(*r, even), 0.0, 0.004);
    const lensprof_finding *finding = r->with(LENSPROF_REASON_FLAT_CENTER_BY_PRIOR);
    assert_non_null(finding);
    assert_close(finding->value[0], r->light_ev, 0.0);
    assert_true(r->light_ev > 0.05);

    FlatPictures sloped = small_card();
    for (auto &v : sloped.vignetting) v = {{-0.3, 0.0, -0.2}, {0.0, 0.0}};
    sloped.gradient[0] = 0.08;
    sloped.shoot(0);
    r = sloped.fit(sloped.options());
    assert_true(r->usable);
    assert_int_equal(r->light, LENSPROF_FLAT_LIGHT_PLANE);
    assert_true(r->light_ev > 0.05);
    assert_close(error_of(*r, sloped), 0.0, 0.003);
}

// In a deep falloff exp(-a r^2), a centre off by little looks like a steep light. Where other falloffs show the light,
// it is warned of.
static void the_depth_is_not_taken_for_a_slope(void **) {
    for (const double stops : {4.0, 6.0})
        for (const double center : {0.01, 0.02}) {
            FlatPictures even = small_card();
            even.set_falloff(center, 0.0, [=](double r) { return std::exp2(-stops * r * r); });
            even.shoot(0);
            auto r = even.fit(even.options());
            assert_true(r->usable);
            assert_null(r->with(LENSPROF_REASON_FLAT_STEEP));
            FlatPictures sloped = small_card();
            sloped.gradient[0] = 0.15;
            sloped.set_falloff(center, 0.0, [=](double q) { return std::exp2(-stops * (0.6 + 0.4 * q * q) * q * q); });
            sloped.shoot(0);
            r = sloped.fit(sloped.options());
            const lensprof_finding *steep = r->with(LENSPROF_REASON_FLAT_STEEP);
            assert_non_null(steep);
            assert_int_equal(steep->severity, LENSPROF_SEVERITY_WARNING);
            assert_close(steep->value[0], 0.15, 0.02);
        }
}

static void dust_texture_and_a_clipped_middle_are_named_each(void **) {
    FlatPictures p = small_card();
    p.width = 600, p.height = 450, p.level = 0.6;
    uint64_t random = 5;
    std::vector<std::array<double, 3>> spots(40);
    for (auto &spot : spots)
        spot = {600 * lp_random(&random), 450 * lp_random(&random), 2.0 + 3.0 * lp_random(&random)};
    const std::vector<double> &normals = normal_numbers();
    p.defect = [&](double x, double y, uint32_t) {
        double light = std::hypot(x - 320, y - 215) < 40 ? 2.5 : 1.0;
        for (const auto &s : spots)
            if (std::hypot(x - s[0], y - s[1]) < s[2]) light *= 0.8;
        const auto grain = static_cast<size_t>(y / 2.5) * 240 + static_cast<size_t>(x / 2.5);  // 2.5 px, 2 %
        return light * (1.0 + 0.02 * normals[grain * 2654435761u % normals.size()]);
    };
    p.shoot(0);
    const auto r = p.fit(p.options());
    assert_true(r->usable);
    const lensprof_finding *white = r->with(LENSPROF_REASON_FLAT_WHITE), *dust = r->with(LENSPROF_REASON_FLAT_DUST),
                           *texture = r->with(LENSPROF_REASON_FLAT_TEXTURE);
    assert_true(white && dust && texture);
    assert_close(white->value[0], 0.019, 0.005);
    assert_non_null(strstr(white->text, "0.05,-0.03 half diagonals"));
    assert_true(dust->value[0] > 25.0 && dust->value[0] < 45.0);
    assert_close(dust->value[1], r->corner_sigma, 0.0);
    assert_true(texture->value[0] > 0.005 && texture->value[1] < 0.005);
    for (int i = 0; i < 3; i++) assert_close(r->vignetting[1].k[i], p.vignetting[1].k[i], 0.02);
    assert_close(error_of(*r, p), 0.0, 0.004);
}

// A light that is curved along a line has as much of a curvature that looks like falloff: the error states it.
static void a_curved_light_is_part_of_the_error(void **) {
    FlatPictures p = small_card();
    p.width = 300, p.height = 200, p.gradient[0] = 0.3, p.bend = 0.25;
    for (uint32_t shot = 0; shot < 3; shot++) p.shoot(shot, 0.0, 90.0 * shot);
    const auto r = p.fit(p.options());
    assert_true(r->usable);
    assert_int_equal(r->light, LENSPROF_FLAT_LIGHT_QUADRATIC);
    const double r2 = lensprof_vignetting_r2(&p.vignetting[1], p.width, p.height, 0.0, 0.0, nullptr);
    const double off = std::fabs(r->corner - lensprof_vignetting_eval(&p.vignetting[1], r2, nullptr));
    assert_true(off > 0.001 && off < 2.0 * r->corner_sigma && r->corner_sigma < 0.01);
    p.bend = 0.0, p.images.clear();
    for (uint32_t shot = 0; shot < 3; shot++) p.shoot(shot, 0.0, 90.0 * shot);
    assert_int_equal(p.fit(p.options())->light, LENSPROF_FLAT_LIGHT_PLANE);
}

// The mean of a cell is not M in its middle.
static void the_falloff_is_that_of_a_pixel(void **) {
    FlatPictures p = small_card(0.0);
    p.sample = LENSPROF_SAMPLE_F32, p.width = 300, p.height = 200;
    p.shoot(0);
    const auto r = p.fit(p.options());
    assert_close(r->corner, p.light(0.0, 0.0, 1, 0.0) / p.light(149.5, 99.5, 1, 0.0), 2e-5);
}

// The verdict does not get better where a light that slopes more looks more like a centre that is off.
static void steeper_light_gets_no_better_verdict(void **) {
    const double half = 0.5 * std::hypot(300.0, 225.0);
    constexpr uint32_t passed = LENSPROF_SEVERITY_PASSED;
    uint32_t worst = passed;
    for (const double slope : {0.08, 0.16, 0.24, 0.28, 0.36, 0.44}) {
        FlatPictures p;
        p.width = 300, p.height = 225, p.noise = 0.001, p.level = 0.9 / (1.0 + 0.5 * slope);
        p.set_falloff(0.0, 0.0, [](double r) { return std::exp2(-5.0 * r * r * (0.95 + 0.05 * r * r)); });
        const Defect falloff = p.defect;
        p.defect = [&](double x, double y, uint32_t c) {
            return falloff(x, y, c) * (1.0 + slope * (x - 149.5) / half);
        };
        p.shoot(0);
        const auto r = p.fit(p.options());
        const lensprof_finding *steep = r->with(LENSPROF_REASON_FLAT_STEEP);
        const uint32_t severity = steep ? steep->severity : passed;
        assert_true(severity >= worst);
        worst = severity;
        if (slope < 0.1) assert_null(steep);
        if (slope > 0.25) assert_false(r->usable);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(up_to_six_stops_are_measured),
        cmocka_unit_test(without_a_grid_a_deep_falloff_is_warned_of),
        cmocka_unit_test(what_lies_outside_the_image_circle_is_left_out),
        cmocka_unit_test(a_dark_strip_leaves_the_rest),
        cmocka_unit_test(a_dark_border_is_no_circle),
        cmocka_unit_test(a_strip_leaves_the_circle),
        cmocka_unit_test(bright_corners_are_no_circle),
        cmocka_unit_test(one_light_is_noted),
        cmocka_unit_test(the_light_is_even_where_that_describes_the_card),
        cmocka_unit_test(the_depth_is_not_taken_for_a_slope),
        cmocka_unit_test(a_curved_light_is_part_of_the_error),
        cmocka_unit_test(the_falloff_is_that_of_a_pixel),
        cmocka_unit_test(dust_texture_and_a_clipped_middle_are_named_each),
        cmocka_unit_test(steeper_light_gets_no_better_verdict),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
