// Invalid input of the flat field fit.
#include "flat_pictures.hpp"

struct Input {
    FlatPictures pictures;
    lensprof_flat_options options;
    std::unique_ptr<FoundFlat> result = std::make_unique<FoundFlat>();
    lensprof_flat *flat = nullptr;
    void *memory = nullptr;
    size_t size = 0;
    lensprof_error error;

    Input() {
        pictures.width = 120, pictures.height = 90;
        pictures.shoot(0);
        pictures.shoot(1, 0.0, 90.0);
        options = pictures.options();
        lensprof_flat_result_init(result.get());
    }
    Input(const Input &) = delete;
    ~Input() { lensprof_flat_destroy(flat); }

    lensprof_status run() {
        const auto count = static_cast<uint32_t>(pictures.images.size());
        lensprof_flat_destroy(flat);
        flat = nullptr;
        const lensprof_status status =
            lensprof_fit_flat(&options, pictures.images.data(), count, memory, size, &flat, &error);
        if (status == LENSPROF_OK) take_flat(flat, *result);
        return status;
    }

    // Checks that the call is refused with a sentence and the result is unchanged.
    void refused(lensprof_status status) {
        lensprof_status got = run();
        if (got != status) print_error("%s: %s\n", lensprof_status_name(got), error.text);
        assert_int_equal(got, status);
        assert_true(strlen(error.text) > 10);
        assert_null(flat);
    }
};

static void good_input_is_taken(void **) {
    Input in;
    assert_ok(in.run());
    assert_true(in.result->usable);
    assert_string_equal(in.error.text, "");
}

static void null_pointers_and_sizes(void **) {
    Input in;
    auto *images = in.pictures.images.data();
    assert_int_equal(lensprof_fit_flat(nullptr, images, 1, nullptr, 0, &in.flat, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_flat(&in.options, nullptr, 1, nullptr, 0, &in.flat, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_flat(&in.options, images, 1, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_flat(&in.options, images, 0, nullptr, 0, &in.flat, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_flat(&in.options, images, 129, nullptr, 0, &in.flat, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    in.options.struct_size = 8;
    in.refused(LENSPROF_ERROR_STRUCT_SIZE);
    Input other;
    other.memory = &other, other.size = lensprof_flat_bytes(2) - 1;
    other.refused(LENSPROF_ERROR_CAPACITY);
    assert_int_equal(lensprof_flat_bytes(0), 0);
    assert_int_equal(lensprof_flat_bytes(LENSPROF_FLAT_IMAGES + 1), 0);
}

struct Spoil {
    lensprof_status status;
    void (*change)(Input &);
};

static void unusable_options(void **) {
    static lensprof_response broken;
    lensprof_response_set_linear(&broken);
    broken.table[7] = 0.9;
    const Spoil cases[] = {
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.channels = 2; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.free |= LENSPROF_FREE_EV; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.vignettings = 2; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.vignettings = 3, in.options.channels = 1; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.light = 4; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.own_light = 2; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.several = 2; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.find_card = 2; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.grid = 3; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.responses = 2; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.reserved = 1; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.ev_sigma = 0.0; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.ev_sigma = NAN; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.prior_weight = -1.0; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.options.prior_weight = INFINITY; }},
        {LENSPROF_ERROR_ARGUMENT,
         [](Input &in) { in.options.several = 1, in.options.light = LENSPROF_FLAT_LIGHT_PLANE; }},
        {LENSPROF_ERROR_NO_UNKNOWNS, [](Input &in) { in.options.free = 0; }},
        {LENSPROF_ERROR_VIGNETTING, [](Input &in) { in.options.vignetting.k[0] = -2.0; }},
        {LENSPROF_ERROR_NOT_FINITE, [](Input &in) { in.options.vignetting.center[1] = NAN; }},
        {LENSPROF_ERROR_RESPONSE, [](Input &in) { in.options.response = &broken; }},
    };
    for (const Spoil &spoil : cases) {
        Input in;
        spoil.change(in);
        in.refused(spoil.status);
    }
}

static void unusable_pictures(void **) {
    static const uint8_t mask[4] = {0, 0, 0, 0};
    const Spoil cases[] = {
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.pictures.images[1].view.data = nullptr; }},
        {LENSPROF_ERROR_SIZE, [](Input &in) { in.pictures.images[1].view.row_bytes = 8; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.pictures.images[0].view.layout = 9; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.pictures.images[0].view.layout = LENSPROF_LAYOUT_GREY; }},
        {LENSPROF_ERROR_SIZE, [](Input &in) { in.pictures.images[0].reduction = 0; }},
        {LENSPROF_ERROR_SIZE, [](Input &in) { in.pictures.images[0].reduction = 2; }},
        {LENSPROF_ERROR_SIZE, [](Input &in) { in.pictures.images[0].width = 100; }},
        {LENSPROF_ERROR_SIZE, [](Input &in) { in.pictures.images[1].width = 140; }},
        {LENSPROF_ERROR_SIZE,
         [](Input &in) { in.pictures.images[1].mask = mask, in.pictures.images[1].mask_row_bytes = 4; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.pictures.images[0].black = 0.99; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.pictures.images[0].white = NAN; }},
        {LENSPROF_ERROR_EXPOSURE, [](Input &in) { in.pictures.images[0].ev = 65.0; }},
        {LENSPROF_ERROR_EXPOSURE, [](Input &in) { in.pictures.images[0].ev = NAN; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.pictures.images[1].rotation_deg = 361.0; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.pictures.images[1].rotation_deg = NAN; }},
        {LENSPROF_ERROR_ARGUMENT, [](Input &in) { in.pictures.images[1].shot = 0; }},
    };
    for (const Spoil &spoil : cases) {
        Input in;
        spoil.change(in);
        in.refused(spoil.status);
    }
}

static void nothing_to_see(void **) {
    Input in;
    std::vector<uint8_t> mask(120 * 90, 0);
    for (auto &image : in.pictures.images) image.mask = mask.data(), image.mask_row_bytes = 120;
    in.refused(LENSPROF_ERROR_NO_SAMPLES);
    Input white;
    for (auto &image : white.pictures.images) image.white = 0.02;
    white.refused(LENSPROF_ERROR_NO_SAMPLES);
}

static void a_pixel_that_is_not_a_number_is_named(void **) {
    Input in;
    FlatPictures floats;
    floats.width = 120, floats.height = 90, floats.sample = LENSPROF_SAMPLE_F32;
    floats.shoot(0);
    auto *data = reinterpret_cast<float *>(floats.data[0]->data());
    data[3 * (120 * 7 + 11) + 1] = NAN;
    in.pictures.images = {floats.images[0]};
    in.refused(LENSPROF_ERROR_NOT_FINITE);
    assert_string_equal(in.error.text, "image 0: pixel 11, 7 is not a finite number");
    assert_int_equal(in.error.item.kind, LENSPROF_ITEM_IMAGE);
    assert_int_equal(in.error.item.text_bytes, strlen("image 0"));
}

static void tiny_and_odd_pictures_are_survived(void **) {
    for (uint32_t width : {1u, 2u, 5u, 13u, 40u})
        for (uint32_t height : {1u, 3u, 17u, 64u}) {
            FlatPictures p;
            p.width = width, p.height = height;
            p.shoot(0);
            lensprof_flat_options o = p.options();
            o.grid = LENSPROF_FLAT_GRID_ALWAYS;
            lensprof_flat *flat = nullptr;
            const lensprof_status status = lensprof_fit_flat(&o, p.images.data(), 1, nullptr, 0, &flat, nullptr);
            assert_true(status == LENSPROF_OK || status == LENSPROF_ERROR_NO_SAMPLES);
            if (status != LENSPROF_OK) continue;
            lensprof_flat_destroy(flat);
            const auto r = p.fit(o);
            assert_int_equal(r->usable, 0);
            assert_true(strlen(r->first.text) > 10);
            for (const auto &v : r->vignetting) assert_ok(lensprof_vignetting_validate(&v));
        }
}

static void random_pictures_are_survived_and_not_usable(void **) {
    uint64_t random = 5;
    for (int round = 0; round < 6; round++) {
        Input in;
        for (auto &data : in.pictures.data)
            for (uint8_t &byte : *data)
                byte = static_cast<uint8_t>(round % 2 ? 256 * lp_random(&random) : 100 * (lp_random(&random) < 0.5));
        in.options.find_card = round / 2 == 1;
        in.options.light = round / 2 == 2 ? LENSPROF_FLAT_LIGHT_QUADRATIC : LENSPROF_FLAT_LIGHT_AUTO;
        lensprof_status status = in.run();
        assert_true(status == LENSPROF_OK || status == LENSPROF_ERROR_NO_SAMPLES);
        assert_int_equal(in.result->usable, 0);
    }
}

struct Watch {
    int calls, cancel_at;
    double last;
};

static int watch(double done, void *user) {
    auto *w = static_cast<Watch *>(user);
    assert_true(done >= w->last && done <= 1.0);
    w->last = done;
    return ++w->calls == w->cancel_at;
}

static void progress_rises_and_cancels(void **) {
    Watch w = {0, 0, 0.0};
    Input in;
    in.options.progress = watch;
    in.options.progress_user = &w;
    assert_ok(in.run());
    assert_true(w.calls > 5 && w.last > 0.9);
    const int calls = w.calls;
    for (int at = 1; at <= calls; at += 7) {
        Input stopped;
        stopped.options.threads = 1;
        w = {0, at, 0.0};
        stopped.options.progress = watch;
        stopped.options.progress_user = &w;
        stopped.refused(LENSPROF_ERROR_CANCELLED);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(good_input_is_taken),
        cmocka_unit_test(null_pointers_and_sizes),
        cmocka_unit_test(unusable_options),
        cmocka_unit_test(unusable_pictures),
        cmocka_unit_test(nothing_to_see),
        cmocka_unit_test(a_pixel_that_is_not_a_number_is_named),
        cmocka_unit_test(tiny_and_odd_pictures_are_survived),
        cmocka_unit_test(random_pictures_are_survived_and_not_usable),
        cmocka_unit_test(progress_rises_and_cancels),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
