// The flat field fit compared with simulated pictures of a known lens.
#include "flat_pictures.hpp"

#include "fit/flat/fit.hpp"

using namespace lensprof;

static void derivatives_are_those_of_central_differences(void **) {
    uint64_t random = 3;
    for (int variant = 0; variant < 16; variant++) {
        FlatModel model;
        model.form = variant & 8 ? FalloffForm::logarithm : FalloffForm::powers;
        model.grid = {600, 400, 96, 64};
        model.curves = variant & 1 ? 3 : 1;
        model.own_light = (variant & 2) != 0;
        model.several = (variant & 4) != 0;
        model.light_terms = model.several ? 0 : 4;
        model.shots = 3;
        for (double turn : {0.0, 1.2, -2.0}) model.turn.push_back({std::cos(turn), std::sin(turn)});
        Eigen::VectorXd u(model.unknowns());
        for (Eigen::Index i = 0; i < u.size(); i++) u[i] = 0.2 * lp_normal(&random);
        for (int shot = 0; shot < 3; shot++)
            for (int channel = 0; channel < 3; channel++) {
                double x = 600 * lp_random(&random), y = 400 * lp_random(&random);
                const auto c = static_cast<size_t>(channel);
                const auto light = [&](const Eigen::VectorXd &at) { return FlatLight(model, at).at(shot, x, y)[c]; };
                const Prediction p = FlatLight(model, u).with_derivatives(shot, x, y)[c];
                assert_close(p.value, light(u), 1e-12 * p.value);
                Eigen::VectorXd by = Eigen::VectorXd::Zero(u.size());
                for (size_t i = 0; i < static_cast<size_t>(p.count); i++) by[p.index[i]] += p.derivative[i];
                for (Eigen::Index i = 0; i < u.size(); i++) {
                    Eigen::VectorXd up = u, down = u;
                    up[i] += 1e-5, down[i] -= 1e-5;
                    const double slope = (light(up) - light(down)) / 2e-5;
                    assert_close(by[i], slope, 1e-7 * (1.0 + std::fabs(slope)));
                }
            }
    }
}

static void a_plain_card_gives_the_falloff(void **) {
    for (uint32_t sample : {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_F32}) {
        FlatPictures p;
        p.sample = sample;
        p.shoot(0);
        auto r = p.fit(p.options());
        assert_true(r->usable);
        assert_int_equal(r->vignettings, 1);
        assert_int_equal(r->spots, 0);
        assert_int_equal(r->gain_grid.columns, 0);
        assert_close(error_of(*r, p), 0.0, 0.002);
        assert_true(r->corner_sigma > 5e-5 && r->corner_sigma < 5e-4);
        assert_reason(*r, FLAT_CENTER_BY_PRIOR, "prior");  // light and centre not separated
        assert_int_equal(r->separated, 0);
    }
}

static void a_grey_picture_has_one_curve(void **) {
    FlatPictures p;
    p.channels = 1;
    p.shoot(0);
    auto r = p.fit(p.options());
    assert_true(r->usable);
    assert_int_equal(r->vignettings, 1);
    assert_close(error_of(*r, p), 0.0, 0.003);
}

static void turned_shots_tell_the_light_from_the_centre(void **) {
    FlatPictures p;
    for (auto &v : p.vignetting) v = {{-0.4, 0.0, 0.0}, {0.04, -0.03}};  // r^2 alone: a plane looks like a shift
    p.gradient[0] = 0.10, p.gradient[1] = -0.06;
    p.shoot(0, 0.0, 0.0);
    lensprof_flat_options o = p.options();
    o.prior_weight = 0.0;
    o.free &= ~(LENSPROF_FREE_K2 | LENSPROF_FREE_K3);
    o.vignetting = {{0, 0, 0}, {0, 0}};
    auto alone = p.fit(o);
    size_t center = 3 * alone->vignettings, n = alone->covariance_size;
    double alone_sigma = n ? std::sqrt(alone->covariance[center * n + center]) : 1.0;
    p.shoot(1, 0.0, 90.0);
    p.shoot(2, 0.3, 180.0);
    lensprof_flat_image_quality quality[3];
    auto r = p.fit(o, quality);
    assert_true(r->usable);
    assert_int_equal(r->separated, 1);
    assert_close(r->vignetting[0].center[0], 0.04, 0.002);
    assert_close(r->vignetting[0].center[1], -0.03, 0.002);
    n = r->covariance_size;
    double sigma = std::sqrt(r->covariance[center * n + center]);
    assert_true(sigma < 0.001 && sigma * 8 < alone_sigma);
    assert_close(quality[0].gradient[0], 0.10, 0.003);
    assert_close(quality[0].gradient[1], -0.06, 0.003);
    assert_close(quality[2].gradient[0], -0.10, 0.003);  // the camera is upside down
    assert_close(quality[1].gradient[0], -0.06, 0.003);  // its right is down in the scene
}

static void exposures_of_one_shot_are_merged(void **) {
    FlatPictures p;
    assert_ok(lensprof_response_set_gamma(&p.response, 2.2));
    p.sample = LENSPROF_SAMPLE_U8;
    p.level = 1.6;  // white in the longest exposure, and nowhere well exposed in a single one
    for (auto &v : p.vignetting) v.k[0] = -0.8;
    for (int ev = -4; ev <= 0; ev++) p.shoot(0, ev);
    lensprof_flat_image_quality quality[5];
    auto r = p.fit(p.options(), quality);
    assert_true(r->usable);
    assert_int_equal(r->shots, 1);
    assert_close(error_of(*r, p), 0.0, 0.002);
    assert_true(quality[4].white_share > 0.2 && quality[0].white_share == 0.0);
    for (const auto &q : quality) assert_close(q.ev_residual, 0.0, 0.01);
    assert_true(quality[0].noise_levels > 0.8 && quality[0].noise_levels < 1.3);  // 0.004 * 255, rounded to 8 bit
    FlatPictures alone = FlatPictures();
    alone.vignetting[0] = alone.vignetting[1] = alone.vignetting[2] = p.vignetting[0];
    alone.response = p.response, alone.sample = p.sample, alone.level = 0.1;
    alone.shoot(0);
    assert_true(alone.fit(alone.options())->corner_sigma > 1.5 * r->corner_sigma);
}

static void wrong_exposures_are_noticed(void **) {
    FlatPictures p;
    p.shoot(0, -1.0), p.shoot(0, 0.0);
    p.images[0].ev = -1.5;
    lensprof_flat_image_quality quality[2];
    auto r = p.fit(p.options(), quality);
    assert_false(r->usable);
    assert_reason(*r, FLAT_EXPOSURE_WRONG, "0.50 EV");
    assert_int_equal(r->first.item.kind, LENSPROF_ITEM_IMAGE);
    assert_close(r->first.value[0], 0.5, 0.02);
    assert_close(quality[0].ev_residual - quality[1].ev_residual, 1.0, 0.02);  // each image compared with the other
}

static void a_card_that_does_not_reach_the_corners_is_said(void **) {
    FlatPictures p;
    std::vector<uint8_t> mask(600 * 450);
    for (uint32_t y = 0; y < 450; y++)
        for (uint32_t x = 0; x < 600; x++) mask[y * 600 + x] = x > 60 && x < 540 && y > 60 && y < 390;
    auto &image = p.shoot(0);
    image.mask = mask.data(), image.mask_row_bytes = 600;
    auto r = p.fit(p.options());
    assert_true(r->usable);
    assert_close(r->radius, 0.75, 0.02);
    assert_reason(*r, SMALL_RADIUS, "extrapolated");
    for (uint32_t y = 0; y < 450; y++)
        for (uint32_t x = 0; x < 600; x++) mask[y * 600 + x] = x > 200 && x < 400 && y > 100 && y < 350;
    r = p.fit(p.options());
    assert_false(r->usable);
    assert_reason(*r, SMALL_RADIUS, "corners");
}

static void channels_get_curves_where_they_differ(void **) {
    FlatPictures p;
    p.vignetting[0].k[0] = -0.48, p.vignetting[2].k[0] = -0.43;
    p.shoot(0);
    auto r = p.fit(p.options());
    assert_int_equal(r->vignettings, 3);
    assert_close(error_of(*r, p), 0.0, 0.003);
    assert_int_equal(r->covariance_size, 11);
    lensprof_flat_options o = p.options();
    o.vignettings = 1;
    assert_int_equal(p.fit(o)->vignettings, 1);
}

static void dust_is_counted_placed_and_left_out(void **) {
    FlatPictures clean, p;
    p.defect = [](double x, double y, uint32_t) {
        return std::hypot(x - 120, y - 90) < 8 ? 0.85 : std::hypot(x - 430, y - 310) < 4 ? 0.93 : 1.0;
    };
    for (uint32_t shot = 0; shot < 2; shot++) clean.shoot(shot, 0, 90 * shot), p.shoot(shot, 0, 90 * shot);
    auto r = p.fit(p.options()), without = clean.fit(clean.options());
    assert_true(r->usable);
    assert_int_equal(without->spots, 0);
    assert_int_equal(r->spots, 2);
    assert_close(r->spot[0].x, 120, 4.0);
    assert_close(r->spot[0].y, 90, 4.0);
    assert_close(r->spot[0].depth, 0.15, 0.02);
    assert_close(r->spot[1].x, 430, 6.0);
    assert_int_equal(r->spot[0].shots, 2);
    assert_true(r->cells < without->cells);
    assert_close(error_of(*r, p), error_of(*without, clean), 2e-4);
    assert_reason(*r, FLAT_DUST, "2 spots");
    assert_close(r->first.value[0], 2.0, 0.0);
}

struct Bad {
    const char *word;
    lensprof_reason code;
    void (*spoil)(FlatPictures &);
};

static void what_is_wrong_is_said(void **) {
    const Bad cases[] = {
        {"white", LENSPROF_REASON_FLAT_WHITE, [](FlatPictures &p) { p.level = 1.3; }},
        {"black", LENSPROF_REASON_FLAT_BLACK, [](FlatPictures &p) { p.level = 0.024; }},
        {"texture", LENSPROF_REASON_FLAT_TEXTURE,
         [](FlatPictures &p) {
             p.defect = [](double x, double y, uint32_t) { return 1 + 0.04 * std::sin(0.3 * x) * std::sin(0.27 * y); };
         }},
        {"rotated", LENSPROF_REASON_FLAT_STEEP, [](FlatPictures &p) { p.gradient[0] = 0.3; }},
        {"noisy", LENSPROF_REASON_CORNER_UNCERTAIN,
         [](FlatPictures &p) { p.noise = 0.1, p.width = 150, p.height = 100; }},
    };
    for (const Bad &bad : cases) {
        FlatPictures p;
        bad.spoil(p);
        p.shoot(0);
        auto r = p.fit(p.options());
        if (r->usable || !strstr(r->first.text, bad.word)) print_error("%s: %s\n", bad.word, r->first.text);
        assert_false(r->usable);
        assert_non_null(strstr(r->first.text, bad.word));
        assert_int_equal(r->first.code, bad.code);
    }
    FlatPictures none;
    none.defect = [](double x, double y, uint32_t) {  // no even region at all
        return std::fmod(std::floor(x / 9) * 0.37 + std::floor(y / 7) * 0.61, 1.0);
    };
    none.shoot(0);
    lensprof_flat_options o = none.options();
    o.find_card = 1;
    lensprof_flat *flat = nullptr;
    assert_int_equal(lensprof_fit_flat(&o, none.images.data(), 1, nullptr, 0, &flat, nullptr),
                     LENSPROF_ERROR_NO_SAMPLES);
}

// A response from (0, 0) through two points to (1, 1).
static lensprof_response bent(double x0, double y0, double x1, double y1) {
    std::vector<double> table;
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) {
        const double x = j / (LENSPROF_RESPONSE_SAMPLES - 1.0);
        table.push_back(x < x0   ? y0 * x / x0
                        : x < x1 ? y0 + (y1 - y0) * (x - x0) / (x1 - x0)
                                 : y1 + (1.0 - y1) * (x - x1) / (1.0 - x1));
    }
    lensprof_response response;
    assert_int_equal(lensprof_response_set_table(&response, table.data(), static_cast<uint32_t>(table.size())),
                     LENSPROF_OK);
    return response;
}

// All grey values of the card correspond to nearly the same light, or barely change with the light.
static void a_response_without_gradation_is_refused(void **) {
    const struct {
        lensprof_response response;
        const char *word;
        lensprof_reason code;
    } cases[] = {{bent(0.49, 0.02, 0.51, 0.98), "step", LENSPROF_REASON_FLAT_RESPONSE},
                 {bent(0.02, 0.49, 0.98, 0.51), "flat", LENSPROF_REASON_FLAT_RESPONSE}};
    for (const auto &one : cases) {
        FlatPictures p;
        for (auto &v : p.vignetting) v = {{0.0, 0.0, 0.0}, {0.0, 0.0}};
        p.shoot(0);
        p.response = one.response;
        auto r = p.fit(p.options());
        if (r->usable || !strstr(r->first.text, one.word)) print_error("%s: %s\n", one.word, r->first.text);
        assert_false(r->usable);
        assert_non_null(strstr(r->first.text, one.word));
        assert_int_equal(r->first.code, one.code);
        assert_int_equal(r->first.item.kind, LENSPROF_ITEM_IMAGE);
    }
}

static void light_that_changes_between_shots_is_noticed(void **) {
    FlatPictures p;
    p.shoot(0);
    p.defect = [](double x, double, uint32_t) { return x < 250 ? 0.94 : 1.0; };  // a shadow
    p.shoot(1);
    auto r = p.fit(p.options());
    assert_false(r->usable);
    assert_reason(*r, FLAT_SHOTS_DIFFER, "shadow");
}

// Of three shots or more, the odd one is named, by its number; of two, neither.
static void the_shot_unlike_the_others_is_named(void **) {
    for (const uint32_t odd : {0u, 1u, 2u}) {
        FlatPictures p;
        p.width = 240, p.height = 160;  // such fits take many rounds
        for (uint32_t shot = 0; shot < 3; shot++) {
            if (shot == odd) p.defect = [](double x, double y, uint32_t) { return 1.0 + 1.25e-5 * x * y; };
            p.shoot(10 + shot);
            p.defect = nullptr;
        }
        lensprof_flat_options o = p.options();
        o.own_light = 1;
        auto r = p.fit(o);
        assert_false(r->usable);
        assert_reason(*r, FLAT_SHOTS_DIFFER, "angles");
        assert_int_equal(r->first.item.kind, LENSPROF_ITEM_SHOT);
        assert_int_equal(r->first.item.index, 10 + odd);
        o.own_light = 0;
        r = p.fit(o);
        assert_reason(*r, FLAT_SHOTS_DIFFER, "angles");
        assert_int_equal(r->first.item.index, 10 + odd);
        assert_close(r->light_ev, 0.0, 0.0);  // no light was chosen, which takes most of the time
        o.own_light = 1;
        const size_t other = odd == 0 ? 1 : 0;
        p.images = {p.images[other], p.images[odd]};
        r = p.fit(o);
        assert_reason(*r, FLAT_SHOTS_DIFFER, "angles");
        assert_int_equal(r->first.item.kind, LENSPROF_ITEM_NONE);
    }
}

static void a_grid_of_a_radial_lens_is_flat(void **) {
    FlatPictures p;
    p.shoot(0);
    lensprof_flat_options o = p.options();
    o.grid = LENSPROF_FLAT_GRID_ALWAYS;
    auto r = p.fit(o);
    assert_int_equal(r->gain_grid.columns, 24);
    for (uint32_t i = 0; i < 3 * 24 * 18; i++) assert_close(r->gain_grid.attenuation[i], 1.0, 0.01);
}

static void reduced_views_and_layouts_are_the_same_picture(void **) {
    FlatPictures p;
    p.set_center(0.02, 0.0);
    p.shoot(0);
    auto full = p.fit(p.options());
    auto small = p.images[0];  // every second pixel: a view whose pixels represent squares of 2 x 2
    std::vector<uint16_t> pixels(300 * 225 * 3), flipped(300 * 225 * 4);
    const auto *from = reinterpret_cast<const uint16_t *>(p.data[0]->data());
    for (uint32_t y = 0; y < 225; y++)
        for (uint32_t x = 0; x < 300; x++)
            for (uint32_t c = 0; c < 3; c++) {
                uint32_t sum = 0;
                for (uint32_t k = 0; k < 4; k++) sum += from[((2 * y + k / 2) * 600 + 2 * x + k % 2) * 3 + c];
                pixels[(y * 300 + x) * 3 + c] = static_cast<uint16_t>(sum / 4);
                flipped[((224 - y) * 300 + x) * 4 + 2 - c] = static_cast<uint16_t>(sum / 4);
                flipped[((224 - y) * 300 + x) * 4 + 3] = 65535;
            }
    small.view = {pixels.data(), 1800, 300, 225, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB};
    small.reduction = 2;
    p.images[0] = small;
    auto reduced = p.fit(p.options());
    assert_close(falloff_error(full->vignetting[0], reduced->vignetting[0], 600, 450), 0.0, 0.001);
    assert_close(reduced->vignetting[0].center[0], 0.02, 0.003);
    p.images[0].view = {flipped.data() + 224 * 1200, -2400, 300, 225, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_BGRA};
    auto bottom_up = p.fit(p.options());
    assert_memory_equal(bottom_up->vignetting, reduced->vignetting, sizeof reduced->vignetting);
}

static void held_values_stay_and_have_no_error(void **) {
    FlatPictures p;
    p.shoot(0);
    lensprof_flat_options o = p.options();
    o.free = LENSPROF_FREE_K1 | LENSPROF_FREE_K2;
    o.vignetting = {{9.0, 9.0, -0.06}, {0.0, 0.0}};
    o.vignetting.k[0] = o.vignetting.k[1] = 0.0;
    auto r = p.fit(o);
    assert_true(r->usable);
    assert_true(r->vignetting[0].k[2] == -0.06 && r->vignetting[0].center[0] == 0.0);
    assert_close(r->vignetting[0].k[0], -0.45, 0.002);
    for (uint32_t i = 0; i < 5; i++) assert_int_equal(r->covariance[i * 5 + i] > 0.0, i < 2);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(derivatives_are_those_of_central_differences),
        cmocka_unit_test(a_plain_card_gives_the_falloff),
        cmocka_unit_test(a_grey_picture_has_one_curve),
        cmocka_unit_test(turned_shots_tell_the_light_from_the_centre),
        cmocka_unit_test(exposures_of_one_shot_are_merged),
        cmocka_unit_test(wrong_exposures_are_noticed),
        cmocka_unit_test(a_card_that_does_not_reach_the_corners_is_said),
        cmocka_unit_test(channels_get_curves_where_they_differ),
        cmocka_unit_test(dust_is_counted_placed_and_left_out),
        cmocka_unit_test(what_is_wrong_is_said),
        cmocka_unit_test(a_response_without_gradation_is_refused),
        cmocka_unit_test(light_that_changes_between_shots_is_noticed),
        cmocka_unit_test(the_shot_unlike_the_others_is_named),
        cmocka_unit_test(a_grid_of_a_radial_lens_is_flat),
        cmocka_unit_test(reduced_views_and_layouts_are_the_same_picture),
        cmocka_unit_test(held_values_stay_and_have_no_error),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
