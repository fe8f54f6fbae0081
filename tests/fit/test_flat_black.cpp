// The black level on simulated cards: stated, shown by two exposures, or left open.
#include "flat_pictures.hpp"

static constexpr double kPlausible = 0.03;  // error of a black level that nobody stated

static FlatPictures small_card(double black) {
    FlatPictures p;
    p.width = 300, p.height = 200;
    p.noise = 0.5 / 255.0;
    for (double &level : p.levels.black) level = black;
    return p;
}

static lensprof_flat_options open_options(const FlatPictures &p) {
    lensprof_flat_options o = p.options();
    o.black_sigma = kPlausible;
    return o;
}

static double corner_of(const FlatPictures &p) {
    const lensprof_vignetting &v = p.vignetting[1];
    return lensprof_vignetting_eval(&v, lensprof_vignetting_r2(&v, p.width, p.height, 0.0, 0.0, nullptr), nullptr);
}

static void a_stated_level_is_subtracted(void **) {
    for (const uint32_t sample : {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_F32}) {
        FlatPictures p = small_card(0.06);
        p.sample = sample;
        p.levels.black[0] = 0.1, p.levels.white = 0.75;
        p.shoot(0);
        lensprof_flat_options o = p.options();
        const auto without = p.fit(o);
        assert_true(without->corner > corner_of(p) + 0.04);
        assert_null(without->with(LENSPROF_REASON_FLAT_BLACK_LEVEL));  // stated as exact
        o.levels = p.levels;
        const auto r = p.fit(o);
        assert_close(error_of(*r, p), 0.0, sample == LENSPROF_SAMPLE_U8 ? 0.006 : 0.003);
        assert_memory_equal(&r->levels, &p.levels, sizeof p.levels);
        assert_null(r->with(LENSPROF_REASON_FLAT_BLACK_LEVEL));
    }
}

// White at the level of a sensor is white, though far below full scale.
static void saturation_is_that_of_the_white_level(void **) {
    FlatPictures p = small_card(0.05);
    p.levels.white = 0.5;
    p.level = 1.4;
    p.shoot(0);
    lensprof_flat_options o = p.options();
    o.levels = p.levels;
    assert_non_null(p.fit(o)->with(LENSPROF_REASON_FLAT_WHITE));
}

static void two_exposures_show_an_offset(void **) {
    const struct {
        double black, second_ev, stated_ev;
        uint32_t sample, second_shot;
    } cards[] = {
        {0.06, -1.5, -1.5, LENSPROF_SAMPLE_U16, 0},   // a shot of two exposures
        {0.06, -1.5, -1.3, LENSPROF_SAMPLE_F32, 0},   // whose times are not exact
        {-0.02, -2.0, -2.0, LENSPROF_SAMPLE_F32, 1},  // two shots; too much was subtracted
        {0.015, -1.0, -1.0, LENSPROF_SAMPLE_U16, 1}, {0.0, -1.0, -1.0, LENSPROF_SAMPLE_U16, 0},
    };
    for (const auto &card : cards) {
        FlatPictures p = small_card(card.black);
        p.sample = card.sample;
        p.shoot(0);
        p.shoot(card.second_shot, card.second_ev).ev = card.stated_ev;
        const auto r = p.fit(open_options(p));
        assert_true(r->usable);
        assert_int_equal(r->black_shown, 1);
        assert_true(r->black_sigma < 0.004);
        for (const double black : r->levels.black) assert_close(black, card.black, 3.5 * r->black_sigma);
        const double by_times = 0.02 * std::fabs(card.stated_ev - card.second_ev);  // which merging takes as exact
        assert_close(r->corner, corner_of(p), 0.002 + by_times + 3.0 * r->corner_sigma);
        const lensprof_finding *finding = r->with(LENSPROF_REASON_FLAT_BLACK_LEVEL);
        assert_int_equal(finding != nullptr, card.black != 0.0);
        if (finding) assert_close(finding->value[0], r->black_offset, 0.0);
    }
}

static void channels_have_offsets_of_their_own(void **) {
    FlatPictures p = small_card(0.03);
    p.levels.black[0] = 0.05, p.levels.black[2] = 0.01;
    p.shoot(0);
    p.shoot(0, -2.0);
    p.shoot(0, -1.0);
    const auto r = p.fit(open_options(p));
    for (int c = 0; c < 3; c++) assert_close(r->levels.black[c], p.levels.black[c], 3.5 * r->black_sigma);
    assert_close(r->black_offset, 0.05, 0.003);
    assert_close(error_of(*r, p), 0.0, 0.004);
}

static void grey_pictures_have_one(void **) {
    FlatPictures p = small_card(0.03);
    p.channels = 1;
    p.shoot(0), p.shoot(0, -1.5);
    const auto r = p.fit(open_options(p));
    assert_int_equal(r->black_shown, 1);
    assert_close(r->black_offset, 0.03, 0.003);
}

// Shots of a hand-held camera: each sees the light from another side.
static void shots_with_a_light_of_their_own_show_it_too(void **) {
    FlatPictures p = small_card(0.05);
    p.gradient[0] = 0.1;
    p.shoot(0);
    p.gradient[0] = -0.06, p.gradient[1] = 0.04;
    p.shoot(1, -1.5);
    lensprof_flat_options o = open_options(p);
    o.own_light = 1;
    const auto r = p.fit(o);
    assert_int_equal(r->black_shown, 1);
    for (const double black : r->levels.black) assert_close(black, 0.05, 0.001 + 3.5 * r->black_sigma);
    assert_close(error_of(*r, p), 0.0, 0.005);
}

// An offset next to a stated level, in the units of the samples.
// Lights of nearly one level show little: what they show must not make a good card worse.
static void a_poorly_shown_offset_is_left_alone(void **) {
    for (const double gradient : {0.02, 0.03, 0.05, 0.08, 0.12}) {
        FlatPictures p = small_card(0.0);
        p.sample = LENSPROF_SAMPLE_U16;
        p.noise = 1.0 / 255.0;
        p.shoot(0);
        p.gradient[0] = gradient;
        p.shoot(1);
        lensprof_flat_options o = open_options(p);
        o.own_light = 1;
        const auto r = p.fit(o);
        assert_true(r->usable);
        assert_close(r->corner, corner_of(p), 0.004);
        if (!r->black_shown) assert_close(r->black_offset, 0.0, 0.0);
    }
}

// Three equal offsets of about three errors: subtracted from all channels or from none.
static void channels_are_decided_together(void **) {
    for (uint32_t seed = 0; seed < 6; seed++) {
        FlatPictures p = small_card(0.008);
        p.sample = LENSPROF_SAMPLE_U16;
        p.noise = 3.0 / 255.0;
        p.level = 0.7 + 0.01 * seed;
        p.shoot(0);
        p.shoot(0, -1.0);
        const auto r = p.fit(open_options(p));
        size_t subtracted = 0;
        for (const double black : r->levels.black) subtracted += black != 0.0;
        assert_true(subtracted == 0 || subtracted == 3);
    }
}

static void an_offset_adds_to_the_stated_level(void **) {
    FlatPictures p = small_card(0.0625);
    p.levels.white = 0.5;
    p.shoot(0);
    p.shoot(0, -1.5);
    lensprof_flat_options o = open_options(p);
    o.levels = p.levels;
    for (double &black : o.levels.black) black = 0.05;
    const auto r = p.fit(o);
    for (const double black : r->levels.black) assert_close(black, 0.0625, 3.5 * r->black_sigma);
    assert_close(r->levels.white, 0.5, 0.0);
    assert_close(r->black_offset, 0.0125, 3.5 * r->black_sigma);
}

static void one_level_leaves_the_corner_open(void **) {
    FlatPictures p = small_card(0.0);
    p.shoot(0);
    const auto one = p.fit(open_options(p));
    p.shoot(1);
    const auto equal = p.fit(open_options(p));
    for (const auto *r : {one.get(), equal.get()}) {
        const lensprof_finding *finding = r->with(LENSPROF_REASON_FLAT_BLACK_LEVEL);
        assert_non_null(finding);
        assert_int_equal(finding->severity, LENSPROF_SEVERITY_NOTE);
        assert_int_equal(r->black_shown, 0);
        assert_true(r->usable);
        assert_close(finding->value[0], r->black_sigma, 0.0);
        assert_close(finding->value[1], r->black_ev, 0.0);
        for (const double black : r->levels.black) assert_close(black, 0.0, 0.0);  // noise alone
    }
    // black_ev is what the corner changes by if the level is that much higher.
    lensprof_flat_options o = p.options();
    p.images.pop_back();
    for (double &black : o.levels.black) black = 0.1 * kPlausible;
    const auto other = p.fit(o);
    assert_close(std::log2(one->corner / other->corner), 0.1 * one->black_ev, 0.01 * one->black_ev);
}

// Only linear pictures have a pedestal that is subtracted from their light.
static void encoded_pictures_have_no_offset(void **) {
    FlatPictures p = small_card(0.0);
    assert_ok(lensprof_response_set_gamma(&p.response, 2.2));
    p.shoot(0);
    p.shoot(0, -1.5);
    const auto r = p.fit(open_options(p));
    assert_close(r->black_sigma, 0.0, 0.0);
    assert_null(r->with(LENSPROF_REASON_FLAT_BLACK_LEVEL));
}

static void errors_are_as_large_as_stated(void **) {
    int within = 0, count = 0;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        FlatPictures p = small_card(0.02 + 0.001 * static_cast<double>(seed));
        p.width = 160, p.height = 120;
        p.seed = seed;
        p.shoot(0);
        p.shoot(0, -1.3);
        const auto r = p.fit(open_options(p));
        for (const double black : r->levels.black) {
            const double z = std::fabs(black - p.levels.black[0]) / r->black_sigma;
            assert_true(z < 4.5);
            within += z < 1.0, count++;
        }
    }
    print_message("%d of %d within one standard error\n", within, count);
    assert_true(within >= 0.5 * count && within <= 0.9 * count);
}

static void the_profile_holds_the_levels(void **) {
    FlatPictures p = small_card(0.06);
    p.shoot(0);
    p.shoot(0, -1.5);
    lensprof_flat_options o = open_options(p);
    lensprof_flat *flat = nullptr;
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    assert_ok(lensprof_fit_flat(&o, p.images.data(), 2, nullptr, 0, &flat, nullptr));
    assert_ok(lensprof_flat_profile(flat, &profile, nullptr));
    lensprof_flat_destroy(flat);
    assert_ok(lensprof_profile_validate(&profile));
    assert_close(profile.levels.black[1], 0.06, 0.004);
    o.black_sigma = 0.3;
    assert_int_equal(lensprof_fit_flat(&o, p.images.data(), 2, nullptr, 0, &flat, nullptr), LENSPROF_ERROR_ARGUMENT);
    o.black_sigma = 0.0, o.levels.white = 0.01, o.levels.black[2] = 0.01;
    assert_int_equal(lensprof_fit_flat(&o, p.images.data(), 2, nullptr, 0, &flat, nullptr), LENSPROF_ERROR_ARGUMENT);
}

// Outside of the image circle there is nothing but black: the offset is found with it, and the circle.
static void black_around_an_image_circle(void **) {
    for (const double black : {0.02, 0.06}) {
        FlatPictures p = small_card(black);
        p.set_falloff(0.0, 0.0, [](double r) { return r < 0.8 ? 1.0 - 0.5 * r * r : 0.0; });
        p.shoot(0);
        p.shoot(0, -1.5).ev = -1.5;
        const auto r = p.fit(open_options(p));
        assert_true(r->usable && r->black_shown);
        assert_close(r->black_offset, black, 0.0005);
        assert_close(r->image_circle.radius, 0.8, 0.01);
        assert_close(found_falloff(*r, p, 230.0, 100.0), 1.0 - 0.5 * std::pow(radius_at(p, 230.0, 100.0), 2), 0.005);
    }
}

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_stated_level_is_subtracted),
        cmocka_unit_test(saturation_is_that_of_the_white_level),
        cmocka_unit_test(two_exposures_show_an_offset),
        cmocka_unit_test(channels_have_offsets_of_their_own),
        cmocka_unit_test(grey_pictures_have_one),
        cmocka_unit_test(shots_with_a_light_of_their_own_show_it_too),
        cmocka_unit_test(a_poorly_shown_offset_is_left_alone),
        cmocka_unit_test(channels_are_decided_together),
        cmocka_unit_test(an_offset_adds_to_the_stated_level),
        cmocka_unit_test(one_level_leaves_the_corner_open),
        cmocka_unit_test(encoded_pictures_have_no_offset),
        cmocka_unit_test(errors_are_as_large_as_stated),
        cmocka_unit_test(black_around_an_image_circle),
        cmocka_unit_test(the_profile_holds_the_levels),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
