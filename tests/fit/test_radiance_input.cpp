// Bad tracks at the C boundary: a status, untouched outputs, a text that names the item; degenerate tracks stay finite.
#include "simulated_tracks.hpp"

#include <string>

namespace {

struct Call : FitRun {
    TrackSimulation s;
    lensprof_fit_options options = radiance_fit();
    std::vector<lensprof_observation> tracks;
    void *memory = nullptr;
    size_t size = 0;
    lensprof_error error;

    Call() {
        s.response = srgb_response();
        s.shortest = 3;
        s.make_tracks(100, 1.0, 0.0, 1.0, 42);
        tracks = s.observations;
        exposures.resize(s.images);
        std::memset(exposures.data(), 0x5A, exposures.size() * sizeof exposures[0]);
    }
    lensprof_status run() {
        auto exposures_before = exposures;
        lensprof_fit *fit = nullptr;
        lensprof_status status = lensprof_fit_radiance(
            &options, s.fit_images.data(), static_cast<uint32_t>(s.fit_images.size()), tracks.data(),
            static_cast<uint32_t>(tracks.size()), memory, size, exposures.data(), &fit, &error);
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

void test_refuses(void **) {
    REFUSED(call.options.struct_size = 1, LENSPROF_ERROR_STRUCT_SIZE);
    REFUSED((call.memory = &call, call.size = 8), LENSPROF_ERROR_CAPACITY);
    REFUSED(call.options.method = LENSPROF_METHOD_TRANSFER, LENSPROF_ERROR_UNSUPPORTED);
    REFUSED(call.options.method = LENSPROF_METHOD_TRANSFER_FUNCTION, LENSPROF_ERROR_UNSUPPORTED);
    REFUSED(call.options.method = 3, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.options.channels = 2, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.options.reference = 6, LENSPROF_ERROR_ARGUMENT);
    REFUSED((call.s.response.table[9] = -1.0, call.options.response = &call.s.response), LENSPROF_ERROR_RESPONSE);
    REFUSED(call.options.vignetting.k[0] = -2.0, LENSPROF_ERROR_VIGNETTING);
    REFUSED(call.s.fit_images[1].width = 0, LENSPROF_ERROR_SIZE);
    REFUSED(call.s.fit_images[1].exposure.ev = INFINITY, LENSPROF_ERROR_EXPOSURE);
    REFUSED(call.s.fit_images[1].ev_of = 6, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.s.fit_images.resize(1), LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.tracks[7].image = 6, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.tracks[7].value[2] = NAN, LENSPROF_ERROR_NOT_FINITE);
    REFUSED(call.tracks[7].value[2] = 1.01, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.tracks[7].value[0] = -0.01, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.tracks[7].xy[0] = INFINITY, LENSPROF_ERROR_NOT_FINITE);
    REFUSED(call.tracks[7].xy[1] = 602.0, LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.tracks[0].point = 0xFFFFFFFFu, LENSPROF_ERROR_ARGUMENT);           // a track with one observation
    REFUSED(call.tracks[0].image = call.tracks[1].image, LENSPROF_ERROR_ARGUMENT);  // the same image twice
    REFUSED(call.tracks.push_back(call.tracks[0]), LENSPROF_ERROR_ARGUMENT);
    REFUSED(call.tracks.clear(), LENSPROF_ERROR_NO_SAMPLES);
    REFUSED(
        [&] {
            for (auto &o : call.tracks) o.value[1] = 1.0;
        }(),
        LENSPROF_ERROR_NO_SAMPLES);
    REFUSED(
        [&] {
            for (auto &o : call.tracks) o.value[0] = 0.0;
        }(),
        LENSPROF_ERROR_NO_SAMPLES);
    REFUSED((call.options.free = 0,
             [&] {
                 for (auto &i : call.s.fit_images) i.free = 0;
             }()),
            LENSPROF_ERROR_NO_UNKNOWNS);
}

void test_names_what_is_wrong(void **) {
    Call call;
    call.tracks[7].image = 6;
    call.run();
    assert_string_equal(call.error.text, "observation 7: image 6 of 6");
    Call twice;
    for (auto &o : twice.tracks) o.point += 40;
    twice.tracks[0].image = twice.tracks[1].image = 2;
    twice.run();
    assert_string_equal(twice.error.text, "point 40: two observations in image 2; leave one out");
}

void test_null(void **) {
    Call call;
    uint32_t count = static_cast<uint32_t>(call.tracks.size());
    lensprof_fit *fit = nullptr;
    assert_int_equal(lensprof_fit_radiance(nullptr, call.s.fit_images.data(), 6, call.tracks.data(), count, nullptr, 0,
                                           call.exposures.data(), &fit, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_radiance(&call.options, nullptr, 6, call.tracks.data(), count, nullptr, 0,
                                           call.exposures.data(), &fit, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_radiance(&call.options, call.s.fit_images.data(), 6, nullptr, count, nullptr, 0,
                                           call.exposures.data(), &fit, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_radiance(&call.options, call.s.fit_images.data(), 6, call.tracks.data(), count,
                                           nullptr, 0, nullptr, &fit, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_radiance(&call.options, call.s.fit_images.data(), 6, call.tracks.data(), count,
                                           nullptr, 0, call.exposures.data(), nullptr, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
}

void test_cancel(void **) {
    for (int allowed : {0, 3, 10}) {
        Call call;
        int left = allowed;
        call.options.progress = [](double done, void *user) {
            assert_true(done >= 0.0 && done <= 1.0);
            return (*static_cast<int *>(user))-- <= 0 ? 1 : 0;
        };
        call.options.progress_user = &left;
        assert_int_equal(call.run(), LENSPROF_ERROR_CANCELLED);
    }
}

bool is_finite(const Call &call) {
    const auto &r = call.result;
    double sum = r.heldout_rms + r.before_rms + r.noise_levels + r.inlier_share + r.frame_share + r.image_share;
    for (const auto &v : r.vignetting) sum += v.k[0] + v.k[1] + v.k[2] + v.center[0] + v.center[1];
    for (double c : r.covariance) sum += c;
    for (double b : r.response.table) sum += b;
    for (const auto &e : call.exposures)
        if (!std::isnan(e.ev)) sum += e.ev + e.white_balance[0] + e.white_balance[2];
    return std::isfinite(sum);
}

// Tracks with little or contradictory information give an unusable result with a reason, never a NaN.
void test_degenerate_tracks_stay_finite(void **) {
    for (int kind = 0; kind < 9; kind++)
        for (uint32_t loss : {LENSPROF_LOSS_ROBUST, LENSPROF_LOSS_HUBER, LENSPROF_LOSS_SQUARED}) {
            Call call;
            call.options.loss = loss;
            uint64_t random = 4;
            auto &tracks = call.tracks;
            for (auto &o : tracks) {
                if (kind == 0)
                    for (double &v : o.value) v = 0.5;  // all equal
                if (kind == 1)
                    for (double &v : o.value) v = lp_random(&random);  // random
                if (kind == 2)
                    for (double &v : o.value) v = lp_random(&random) < 0.5 ? 0.0 : 1.0;  // black or white
                if (kind == 3)
                    for (double &v : o.value) v = 3.0 / 255.0;  // nearly black
                if (kind == 4)
                    for (double &v : o.value) v = o.image % 2 ? 1.0 : v;  // every second observation is white
                if (kind == 5)
                    for (double &v : o.value) v = o.image ? 0.003 : 0.97;  // steps of 8 EV and more
                if (kind == 6) o.xy[0] = 400.0, o.xy[1] = 300.0;           // all at one place
            }
            if (kind == 7) tracks.resize(3);  // one track
            if (kind == 8)                    // unconnected images
                for (auto &o : tracks) o.point = 2 * o.point + o.image / 3;
            if (kind == 8) {
                std::vector<lensprof_observation> kept;
                for (const auto &o : tracks) {
                    auto same =
                        std::count_if(tracks.begin(), tracks.end(), [&](const auto &p) { return p.point == o.point; });
                    if (same > 1) kept.push_back(o);
                }
                tracks = kept;
            }
            if (kind == 2) {  // two measured ones: otherwise there is nothing to fit
                for (size_t i = 0; i < 2; i++) std::fill_n(tracks[i].value, 3, 0.5);
            }
            assert_ok(call.run());
            assert_true(is_finite(call));
            assert_true(is_monotone(call.result.response));
            if (kind != 4 && kind != 6) assert_int_equal(call.result.usable, 0);
            if (!call.result.usable) assert_true(std::string(call.result.first.text).size() > 20);
        }
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refuses),
        cmocka_unit_test(test_names_what_is_wrong),
        cmocka_unit_test(test_null),
        cmocka_unit_test(test_cancel),
        cmocka_unit_test(test_degenerate_tracks_stay_finite),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
