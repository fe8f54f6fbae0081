// Bad input at the C boundary: a status and untouched outputs; never a crash or a NaN.
#include "simulated.hpp"

namespace {

struct Call : FitRun {
    Simulation s;
    lensprof_fit_options options;
    void *memory = nullptr;
    size_t size = 0;
    lensprof_error error;

    Call() {
        s.response = srgb_response();
        s.make(200, 1.0, 0.0, 1.0, 42);
        lensprof_fit_options_init(&options);
        exposures.resize(s.images);
        std::memset(exposures.data(), 0x5A, exposures.size() * sizeof exposures[0]);
    }
    lensprof_status run() {
        auto exposures_before = exposures;
        lensprof_fit *fit = nullptr;
        lensprof_status status = lensprof_fit_overlap(
            &options, s.fit_images.data(), static_cast<uint32_t>(s.fit_images.size()), s.pairs.data(),
            static_cast<uint32_t>(s.pairs.size()), memory, size, exposures.data(), &fit, &error);
        if (status != LENSPROF_OK) {
            assert_memory_equal(exposures.data(), exposures_before.data(), exposures.size() * sizeof exposures[0]);
            assert_null(fit);
            assert_true(error.text[0] != 0);
        }
        if (status == LENSPROF_OK) take(fit);
        return status;
    }
};

#define REFUSED(change, status)               \
    do {                                      \
        Call call;                            \
        change;                               \
        assert_int_equal(call.run(), status); \
    } while (0)

// An invalid option is named with its range, and no other option is.
void test_a_wrong_option_is_named(void **) {
    const struct {
        void (*spoil)(lensprof_fit_options &);
        const char *text;
    } cases[] = {
        {[](lensprof_fit_options &o) { o.channels = 2; }, "fit options: channels must be 1 or 3"},
        {[](lensprof_fit_options &o) { o.modes = 26; }, "fit options: modes must be 0..25 or LENSPROF_MODES_AUTO"},
        {[](lensprof_fit_options &o) { o.max_iterations = 0; }, "fit options: max_iterations must be 1..1000000"},
        {[](lensprof_fit_options &o) { o.vignettings = 2; }, "fit options: vignettings must be 0, 1 or 3"},
        {[](lensprof_fit_options &o) { o.refine = 2; }, "fit options: refine must be 0 or 1"},
        {[](lensprof_fit_options &o) { o.moving_camera = 2; }, "fit options: moving_camera must be 0 or 1"},
    };
    for (const auto &one : cases) {
        Call call;
        one.spoil(call.options);
        assert_int_equal(call.run(), LENSPROF_ERROR_ARGUMENT);
        assert_string_equal(call.error.text, one.text);
        assert_int_equal(call.error.item.kind, LENSPROF_ITEM_NONE);
    }
}

// The error gives the index of an invalid image or pair separately from the text.
void test_a_wrong_item_is_named(void **) {
    Call call;
    call.s.pairs[7].value[1][2] = 1.01;
    assert_int_equal(call.run(), LENSPROF_ERROR_ARGUMENT);
    assert_string_equal(call.error.text, "pair 7: grey values must be 0..1");
    assert_int_equal(call.error.item.kind, LENSPROF_ITEM_PAIR);
    assert_int_equal(call.error.item.index, 7);
    assert_int_equal(call.error.item.text_bytes, strlen("pair 7"));
    Call other;
    other.s.fit_images[1].ev_of = 6;
    assert_int_equal(other.run(), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(other.error.item.kind, LENSPROF_ITEM_IMAGE);
    assert_int_equal(other.error.item.index, 1);
    other.s.fit_images[1].ev_of = 1;
    assert_ok(other.run());
    assert_int_equal(other.error.item.kind, LENSPROF_ITEM_NONE);
}

void test_refuses(void **) {
    REFUSED(call.options.struct_size = 1, LENSPROF_ERROR_STRUCT_SIZE);
    REFUSED((call.memory = &call, call.size = 8), LENSPROF_ERROR_CAPACITY);
    REFUSED(call.options.channels = 2, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.options.reference = 6, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.options.modes = 26, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.options.loss = 3, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.options.huber_levels = NAN, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.options.prior_weight = -1.0, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.options.max_iterations = 0, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.options.vignetting.k[0] = -2.0, LENSPROF_ERROR_VIGNETTING);
    REFUSED((call.s.response.table[9] = -1.0, call.options.response = &call.s.response), LENSPROF_ERROR_RESPONSE);
    REFUSED(call.s.fit_images[1].width = 0, LENSPROF_ERROR_SIZE);
    REFUSED(call.s.fit_images[1].exposure.ev = INFINITY, LENSPROF_ERROR_EXPOSURE);
    REFUSED(call.s.fit_images[1].ev_of = 6, LENSPROF_ERROR_ARGUMENT);
    REFUSED((call.s.fit_images[1].ev_of = 2, call.s.fit_images[2].ev_of = 3), LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.s.pairs[7].image[0] = 6, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.s.pairs[7].image[0] = call.s.pairs[7].image[1], LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.s.pairs[7].value[1][2] = NAN, LENSPROF_ERROR_NOT_FINITE);
    REFUSED(call.s.pairs[7].value[1][2] = 1.01, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.s.pairs[7].xy[0][0] = INFINITY, LENSPROF_ERROR_NOT_FINITE);
    REFUSED(call.s.pairs[7].xy[0][0] = 1e9, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.s.pairs[7].xy[0][0] = 802.0, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.options.max_iterations = 0xFFFFFFFFu, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.options.free = LENSPROF_FREE_EV, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.s.fit_images[1].free = 0x100, LENSPROF_ERROR_ARGUMENT);
    REFUSED((call.options.free = 0, call.options.channels = 1,
             [&] {
                 for (auto &i : call.s.fit_images) i.free = LENSPROF_FREE_RED;
             }()),
            LENSPROF_ERROR_NO_UNKNOWNS);
    REFUSED((call.options.free = 0,
             [&] {
                 for (auto &i : call.s.fit_images) i.ev_of = 0, i.free = LENSPROF_FREE_EV;
             }()),
            LENSPROF_ERROR_NO_UNKNOWNS);
    REFUSED(call.s.pairs.clear(), LENSPROF_ERROR_NO_SAMPLES);
    REFUSED(call.s.fit_images.resize(1), LENSPROF_ERROR_ARGUMENT);
    REFUSED((call.options.free = 0,
             [&] {
                 for (auto &i : call.s.fit_images) i.free = 0;
             }()),
            LENSPROF_ERROR_NO_UNKNOWNS);
}

// Pairs without information: one pair repeated, one grey value, only black and white.
void test_data_without_information_are_not_usable(void **) {
    for (int kind = 0; kind < 4; kind++)
        for (double prior : {0.0, 1.0}) {
            Call call;
            call.options.prior_weight = prior;
            for (auto &pair : call.s.pairs) {
                auto value = kind == 0 ? call.s.pairs[0].value[0][1] : kind == 1 ? 0.5 : kind == 2 ? 0.0 : 1.0;
                if (kind == 0)
                    pair = call.s.pairs[0];
                else
                    for (auto &side : pair.value) side[0] = side[1] = side[2] = value;
            }
            assert_ok(call.run());
            assert_int_equal(call.result.usable, 0);
            assert_true(call.result.first.text[0] != 0);
            for (uint32_t i = 0; i < call.result.covariance_size; i++)
                assert_true(call.result.covariance[i * call.result.covariance_size + i] >= 0.0);
        }
}

int stop(double, void *user) { return ++*static_cast<int *>(user) > 3; }

void test_progress_cancels(void **) {
    Call call;
    int asked = 0;
    call.options.progress = stop;
    call.options.progress_user = &asked;
    assert_int_equal(call.run(), LENSPROF_ERROR_CANCELLED);
    assert_int_equal(asked, 4);
}

// Valid numbers without meaning: constant values, saturated values, one pair, all values random.
void test_degenerate_problems_stay_finite(void **) {
    uint64_t random = 17;
    for (int trial = 0; trial < 150; trial++) {
        Call call;
        auto &pairs = call.s.pairs;
        pairs.resize(1 + static_cast<size_t>(lp_random(&random) * 120));
        for (auto &pair : pairs)
            for (int side = 0; side < 2; side++) {
                for (int c = 0; c < 3; c++) {
                    double &v = pair.value[side][c];
                    if (trial % 6 == 0) v = 0.0;
                    if (trial % 6 == 1) v = 1.0;
                    if (trial % 6 == 2) v = lp_random(&random);
                    if (trial % 6 == 3) v = std::round(lp_random(&random));
                    if (trial % 6 == 4) v = 0.5;
                }
                if (trial % 5 == 0) pair.xy[side][0] = pair.xy[side][1] = 0.0;
                if (trial % 7 == 0) pair.image[side] = static_cast<uint32_t>(side);
            }
        call.options.modes = trial % 3 ? LENSPROF_MODES_AUTO : 5;
        call.options.loss = static_cast<uint32_t>(trial % 3);
        call.options.prior_weight = trial % 4 ? 1.0 : 0.0;
        call.options.max_iterations = 40;
        assert_ok(call.run());
        assert_ok(lensprof_response_validate(&call.result.response));
        assert_ok(lensprof_vignetting_validate(&call.result.vignetting[0]));
        for (const auto &e : call.exposures)
            if (!std::isnan(e.ev)) assert_ok(lensprof_exposure_validate(&e));
        assert_true(std::isfinite(call.result.heldout_rms) && std::isfinite(call.result.noise_levels));
        for (double value : call.result.covariance) assert_true(std::isfinite(value));
    }
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refuses),
        cmocka_unit_test(test_a_wrong_option_is_named),
        cmocka_unit_test(test_a_wrong_item_is_named),
        cmocka_unit_test(test_data_without_information_are_not_usable),
        cmocka_unit_test(test_progress_cancels),
        cmocka_unit_test(test_degenerate_problems_stay_finite),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
