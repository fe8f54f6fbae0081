// Levelled frames: exposures and curves compared with the truth of rendered frames, cuts, odd frames, and refusals.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

extern "C" {
#include "support.h"
}
#undef fail

#include <lensprof/deflicker.h>

#include "fit/deflicker/curve.hpp"

namespace {

constexpr uint32_t kWidth = 192, kHeight = 128;

double srgb(double x) {
    x = std::min(std::max(x, 0.0), 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

struct Close {
    void operator()(lensprof_deflicker *deflicker) const { lensprof_deflicker_destroy(deflicker); }
};
using Deflicker = std::unique_ptr<lensprof_deflicker, Close>;

// What a frame shows.
struct Shot {
    double ev = 0.0, seconds = NAN, settings_ev = NAN, f_number = NAN;
    double red = 1.0;
    int scene = 0;
    double shift = 0.0;  // px
    double phase = 0.0;  // of things that move
    std::function<double(double r2)> falloff;
    std::function<double(double y)> rows;  // EV
};

// Texture of four waves, on which a few dark things move.
double light(double x, double y, const Shot &shot) {
    const double u = (x - shot.shift) / (9.0 + 4.0 * shot.scene), v = y / (11.0 - 2.5 * shot.scene) + 3.0 * shot.scene;
    double value = 0.16
                   * std::exp(0.5 * std::sin(u + 0.4 * v) + 0.4 * std::cos(1.3 * v - 0.2 * u)
                              + 0.5 * std::sin(0.11 * u + 0.13 * v + shot.scene));
    for (int n = 0; n < 4; n++) {
        const double at = std::fmod(40.0 * n + 9.0 * shot.phase, kWidth + 20.0) - 10.0;
        if (std::abs(x - at) < 6.0 && std::abs(y - 70.0 - 8.0 * n) < 10.0) value *= 0.3;
    }
    return value;
}

struct Frame {
    std::vector<uint8_t> pixels;
    lensprof_image view() const {
        return {pixels.data(), ptrdiff_t(kWidth) * 3, kWidth, kHeight, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
    }
};

Frame render(const Shot &shot, uint64_t &random) {
    Frame frame;
    for (uint32_t y = 0; y < kHeight; y++)
        for (uint32_t x = 0; x < kWidth; x++) {
            const double dx = x - (kWidth - 1) / 2.0, dy = y - (kHeight - 1) / 2.0;
            const double r2 = (dx * dx + dy * dy) / ((kWidth * kWidth + kHeight * kHeight) / 4.0);
            double e = light(x, y, shot) * std::exp2(shot.ev) * (shot.falloff ? shot.falloff(r2) : 1.0);
            if (shot.rows) e *= std::exp2(shot.rows(double(y) / kHeight));
            for (int c = 0; c < 3; c++) {
                const double value = 255.0 * srgb(e * (c == 0 ? shot.red : 1.0)) + 0.8 * lp_normal(&random);
                frame.pixels.push_back(static_cast<uint8_t>(std::min(std::max(value + 0.5, 0.0), 255.0)));
            }
        }
    return frame;
}

lensprof_status add(lensprof_deflicker *deflicker, const Frame &frame, const Shot &shot) {
    lensprof_deflicker_facts facts;
    lensprof_deflicker_facts_init(&facts);
    facts.seconds = shot.seconds, facts.settings_ev = shot.settings_ev, facts.f_number = shot.f_number;
    const lensprof_image view = frame.view();
    return lensprof_deflicker_add(deflicker, &view, &facts, nullptr);
}

Deflicker make(const lensprof_deflicker_options *options = nullptr) {
    lensprof_deflicker *made = nullptr;
    assert_ok(lensprof_deflicker_create(options, &made, nullptr));
    return Deflicker(made);
}

Deflicker measured(const std::vector<Shot> &shots, lensprof_deflicker_result &result, bool rows = false) {
    lensprof_deflicker_options options;
    lensprof_deflicker_options_init(&options);
    options.rows = rows;
    Deflicker deflicker = make(&options);
    uint64_t random = 4;
    for (const Shot &shot : shots) assert_ok(add(deflicker.get(), render(shot, random), shot));
    lensprof_deflicker_result_init(&result);
    assert_ok(lensprof_deflicker_measure(deflicker.get(), &result, nullptr));
    return deflicker;
}

lensprof_deflicker_frame frame_at(const Deflicker &deflicker, size_t index) {
    lensprof_deflicker_frame frame;
    lensprof_deflicker_frame_init(&frame);
    assert_ok(lensprof_deflicker_frame_at(deflicker.get(), static_cast<uint32_t>(index), &frame, nullptr));
    return frame;
}

std::vector<Shot> flicker(size_t count, double spread, uint64_t seed = 9) {
    std::vector<Shot> shots(count);
    for (size_t i = 0; i < count; i++) {
        shots[i].ev = spread * lp_normal(&seed);
        shots[i].phase = double(i);
    }
    return shots;
}

std::vector<lensprof_exposure> curve_of(const Deflicker &deflicker, size_t count,
                                        const lensprof_deflicker_target *target) {
    std::vector<lensprof_exposure> wanted(count);
    assert_ok(lensprof_deflicker_curve(deflicker.get(), target, wanted.data(), static_cast<uint32_t>(count), nullptr,
                                       nullptr));
    return wanted;
}

lensprof_deflicker_target target_to(uint32_t to) {
    lensprof_deflicker_target target;
    lensprof_deflicker_target_init(&target);
    target.to = to;
    return target;
}

void test_flicker_is_measured_and_levelled(void **) {
    std::vector<Shot> shots = flicker(40, 0.1);
    for (size_t i = 0; i < shots.size(); i++) shots[i].red = 1.0 + 0.05 * std::sin(1.9 * double(i));
    lensprof_deflicker_result result;
    const Deflicker deflicker = measured(shots, result);
    assert_int_equal(result.levelled, 40);
    assert_int_equal(result.segments, 1);
    assert_int_equal(result.moving, 0);
    assert_true(result.tone_error < 0.02);
    const auto wanted = curve_of(deflicker, 40, nullptr);
    double before = 0.0;
    for (size_t i = 0; i < 40; i++) {
        const lensprof_deflicker_frame frame = frame_at(deflicker, i);
        assert_close(frame.exposure.ev, shots[i].ev - shots[0].ev, 0.004);
        assert_close(frame.exposure.white_balance[0], shots[i].red / shots[0].red, 0.004);
        const double after = shots[i].ev + wanted[i].ev - frame.exposure.ev;
        if (i > 0) assert_close(after, before, 0.004);
        before = after;
    }
}

// Every stated error holds: of the ratios of neighbours, two thirds lie within one standard error, more or less.
void test_errors_hold(void **) {
    const std::vector<Shot> shots = flicker(120, 0.15);
    lensprof_deflicker_result result;
    const Deflicker deflicker = measured(shots, result);
    int within = 0, far = 0;
    for (size_t i = 1; i < shots.size(); i++) {
        const lensprof_deflicker_frame frame = frame_at(deflicker, i);
        const double ratio = frame.exposure.ev - frame_at(deflicker, i - 1).exposure.ev;
        const double error = std::abs(ratio - (shots[i].ev - shots[i - 1].ev)) / frame.ev_sigma;
        within += error<1.0, far += error> 4.0;
    }
    assert_true(within > 70);
    assert_int_equal(far, 0);
}

void test_kept_light(void **) {
    std::vector<Shot> shots(60);
    uint64_t random = 3;
    for (size_t i = 0; i < shots.size(); i++) {  // dusk of 3 EV, which the camera follows in thirds
        const double dusk = -3.0 * double(i) / 59.0;
        shots[i].settings_ev = std::round(-dusk * 3.0) / 3.0;
        shots[i].ev = dusk + shots[i].settings_ev + 0.02 * lp_normal(&random);
        shots[i].seconds = 10.0 * double(i);
    }
    lensprof_deflicker_result result;
    const Deflicker deflicker = measured(shots, result);
    assert_close(result.known_range, 3.0, 1e-9);
    lensprof_deflicker_target target = target_to(LENSPROF_TO_LIGHT);
    const auto wanted = curve_of(deflicker, 60, &target);
    for (size_t i = 0; i < 60; i++) assert_close(wanted[i].ev - wanted[0].ev, -3.0 * double(i) / 59.0, 0.02);
    assert_true(wanted[0].ev < 0.1);
    target = target_to(LENSPROF_TO_SMOOTH);
    for (const lensprof_exposure &exposure : curve_of(deflicker, 60, &target)) assert_close(exposure.ev, 0.0, 0.25);
}

void test_targets(void **) {
    const std::vector<Shot> shots = flicker(12, 0.2);
    lensprof_deflicker_result result;
    const Deflicker deflicker = measured(shots, result);
    double mean = 0.0;
    for (size_t i = 0; i < 12; i++) mean += frame_at(deflicker, i).exposure.ev / 12.0;
    lensprof_deflicker_target target = target_to(LENSPROF_TO_MEAN);
    for (const auto &exposure : curve_of(deflicker, 12, &target)) assert_close(exposure.ev, mean, 1e-9);
    target = target_to(LENSPROF_TO_FRAME);
    target.frame = 5;
    for (const auto &exposure : curve_of(deflicker, 12, &target))
        assert_close(exposure.ev, frame_at(deflicker, 5).exposure.ev, 1e-9);
    std::vector<double> curve;
    for (int i = 0; i < 12; i++) curve.push_back(0.1 * i + 3.0);
    target = target_to(LENSPROF_TO_CURVE);
    target.curve = curve.data();
    const auto wanted = curve_of(deflicker, 12, &target);
    for (int i = 0; i < 12; i++) assert_close(wanted[size_t(i)].ev, 0.1 * i + 3.0, 1e-9);
}

void test_cuts_and_odd_frames(void **) {
    std::vector<Shot> shots = flicker(30, 0.1);
    for (size_t i = 15; i < 30; i++) shots[i].scene = 1;  // a cut
    shots[7].scene = 2;                                   // one frame of something else
    shots[3].ev = -9.0, shots[20].ev = 9.0;
    lensprof_deflicker_result result;
    const Deflicker deflicker = measured(shots, result);
    assert_int_equal(result.segments, 2);
    assert_int_equal(result.levelled, 27);
    assert_int_equal(frame_at(deflicker, 3).state, LENSPROF_FRAME_DARK);
    assert_int_equal(frame_at(deflicker, 7).state, LENSPROF_FRAME_DISAGREES);
    assert_int_equal(frame_at(deflicker, 20).state, LENSPROF_FRAME_WHITE);
    for (size_t i = 0; i < 30; i++) {
        const lensprof_deflicker_frame frame = frame_at(deflicker, i);
        if (frame.state != LENSPROF_FRAME_LEVELLED) continue;
        assert_int_equal(frame.segment, i >= 15);
        assert_close(frame.exposure.ev, shots[i].ev - shots[i < 15 ? 0 : 15].ev, 0.004);
    }
    const auto wanted = curve_of(deflicker, 30, nullptr);
    for (size_t i : {size_t(3), size_t(7), size_t(20)}) assert_close(wanted[i].ev, 0.0, 0.0);
}

void test_slow_movement_and_bumps(void **) {
    std::vector<Shot> shots = flicker(30, 0.1);
    for (size_t i = 0; i < 30; i++) shots[i].shift = 0.6 * double(i) + (i >= 18 ? 7.0 : 0.0);
    lensprof_deflicker_result result;
    const Deflicker deflicker = measured(shots, result);
    assert_int_equal(result.segments, 1);
    assert_int_equal(result.moving, 0);
    for (size_t i = 1; i < 30; i++) {
        const double ratio = frame_at(deflicker, i).exposure.ev - frame_at(deflicker, i - 1).exposure.ev;
        assert_close(ratio, shots[i].ev - shots[i - 1].ev, 0.012);
    }
    assert_close(frame_at(deflicker, 29).shift[0], shots[29].shift / kWidth, 0.01);
    for (Shot &shot : shots) shot.shift *= 10.0;  // no longer slow
    measured(shots, result);
    assert_int_equal(result.moving, 1);
}

void test_repeated_frames(void **) {
    const std::vector<Shot> shots = flicker(6, 0.1);
    Deflicker deflicker = make();
    uint64_t random = 1;
    const Frame twice = render(shots[2], random);
    for (size_t i = 0; i < 6; i++)
        assert_ok(add(deflicker.get(), i == 2 || i == 3 ? twice : render(shots[i], random), shots[i]));
    lensprof_deflicker_result result;
    lensprof_deflicker_result_init(&result);
    assert_ok(lensprof_deflicker_measure(deflicker.get(), &result, nullptr));
    assert_int_equal(result.repeated, 1);
    assert_int_equal(frame_at(deflicker, 3).repeats, 1);
}

void test_wrong_response_is_noticed(void **) {
    const std::vector<Shot> shots = flicker(20, 0.3);
    lensprof_deflicker_options options;
    lensprof_deflicker_options_init(&options);
    lensprof_response curved;  // the exponent alone would not show
    std::vector<double> table;
    for (int i = 0; i <= 100; i++) table.push_back(i / 100.0 - 0.1 * std::sin(0.0628318530717959 * i));
    assert_ok(lensprof_response_set_table(&curved, table.data(), 101));
    options.response = &curved;
    Deflicker deflicker = make(&options);
    uint64_t random = 1;
    for (const Shot &shot : shots) assert_ok(add(deflicker.get(), render(shot, random), shot));
    lensprof_deflicker_result result;
    lensprof_deflicker_result_init(&result);
    assert_ok(lensprof_deflicker_measure(deflicker.get(), &result, nullptr));
    assert_true(result.tone_error > 0.05);  // 0.02 with the right one
}

void test_falloff_of_apertures(void **) {
    std::vector<Shot> shots = flicker(24, 0.05);
    for (size_t i = 0; i < 24; i++) {
        const bool is_open = i >= 14;
        shots[i].f_number = is_open ? 2.8 : 8.0;
        shots[i].falloff = [is_open](double r2) { return 1.0 - (is_open ? 0.5 : 0.15) * r2; };
    }
    lensprof_deflicker_result result;
    const Deflicker deflicker = measured(shots, result);
    lensprof_gain_grid grid;
    assert_ok(lensprof_deflicker_shading(deflicker.get(), 20, &grid, nullptr));
    assert_int_equal(grid.columns, LENSPROF_GRID_SIDE);
    assert_close(double(grid.attenuation[0]), 0.5 / 0.85, 0.02);
    assert_close(lensprof_gain_grid_eval(&grid, 101, 101, 50, 50, 0), 1.0, 0.01);
    assert_ok(lensprof_deflicker_shading(deflicker.get(), 2, &grid, nullptr));  // at the aperture of most frames
    assert_int_equal(grid.columns, 0);
}

void test_flicker_of_lines(void **) {
    std::vector<Shot> shots = flicker(40, 0.02);
    const auto wave = [](size_t i, double y) { return 0.12 * std::sin(6.283 * (2.5 * y + 0.37 * double(i))); };
    for (size_t i = 0; i < 40; i++) shots[i].rows = [wave, i](double y) { return wave(i, y); };
    lensprof_deflicker_result result;
    const Deflicker deflicker = measured(shots, result, true);
    double before = 0.0, after = 0.0;
    for (size_t i = 5; i < 35; i++) {
        lensprof_gain_grid grid;
        assert_ok(lensprof_deflicker_shading(deflicker.get(), uint32_t(i), &grid, nullptr));
        double mean = 0.0;
        for (uint32_t y = 0; y < kHeight; y += 4)
            mean += wave(i, double(y) / kHeight) - std::log2(lensprof_gain_grid_eval(&grid, kWidth, kHeight, 9, y, 0));
        mean /= kHeight / 4;
        for (uint32_t y = 0; y < kHeight; y += 4) {
            const double truth = wave(i, double(y) / kHeight);
            const double rest = truth - std::log2(lensprof_gain_grid_eval(&grid, kWidth, kHeight, 9, y, 0)) - mean;
            before += truth * truth, after += rest * rest;
        }
    }
    assert_true(after < 0.1 * before);
}

void test_curves(void **) {
    std::vector<double> times, flat, dusk;
    uint64_t random = 8;
    for (int i = 0; i < 200; i++) {
        times.push_back(i);
        flat.push_back(0.07 * lp_normal(&random));
        dusk.push_back(-4.0 / (1.0 + std::exp(-(i - 100) / 20.0)) + 0.05 * lp_normal(&random));
    }
    const auto level = lensprof::smooth_curve(times, flat, lensprof::best_window(times, flat));
    for (size_t i = 1; i < 200; i++) assert_close(level[i], level[i - 1], 0.005);
    const auto curve = lensprof::smooth_curve(times, dusk, lensprof::best_window(times, dusk));
    for (size_t i = 0; i < 200; i++) assert_close(curve[i], -4.0 / (1.0 + std::exp(-(double(i) - 100) / 20.0)), 0.12);
}

void test_order_of_calls_and_bad_input(void **) {
    Deflicker deflicker = make();
    const std::vector<Shot> shots = flicker(3, 0.1);
    uint64_t random = 1;
    const Frame frame = render(shots[0], random);
    lensprof_image view = frame.view();
    lensprof_deflicker *const d = deflicker.get();
    lensprof_deflicker_frame at;
    lensprof_deflicker_frame_init(&at);
    lensprof_exposure wanted[3];
    lensprof_error error;
    assert_int_equal(lensprof_deflicker_frame_at(d, 0, &at, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_deflicker_measure(d, nullptr, &error), LENSPROF_ERROR_NO_SAMPLES);
    assert_int_equal(lensprof_deflicker_add(nullptr, &view, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_deflicker_add(d, nullptr, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    lensprof_deflicker_facts facts = {};
    assert_int_equal(lensprof_deflicker_add(d, &view, &facts, &error), LENSPROF_ERROR_STRUCT_SIZE);
    lensprof_deflicker_facts_init(&facts);
    facts.seconds = INFINITY;
    assert_int_equal(lensprof_deflicker_add(d, &view, &facts, &error), LENSPROF_ERROR_ARGUMENT);
    facts.seconds = 5.0;
    assert_ok(lensprof_deflicker_add(d, &view, &facts, &error));
    facts.seconds = 4.0;
    assert_int_equal(lensprof_deflicker_add(d, &view, &facts, &error), LENSPROF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "must not decrease"));
    assert_int_equal(lensprof_deflicker_add(d, &view, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    facts.seconds = 6.0;
    view.height = kHeight / 2;
    assert_int_equal(lensprof_deflicker_add(d, &view, &facts, &error), LENSPROF_ERROR_SIZE);
    view = frame.view(), view.layout = LENSPROF_LAYOUT_RGGB;
    assert_true(lensprof_deflicker_add(d, &view, &facts, &error) != LENSPROF_OK);
    view = frame.view();
    assert_ok(lensprof_deflicker_add(d, &view, &facts, &error));
    assert_ok(lensprof_deflicker_measure(d, nullptr, &error));
    assert_int_equal(lensprof_deflicker_frame_at(d, 2, &at, &error), LENSPROF_ERROR_ARGUMENT);
    view.sample = LENSPROF_SAMPLE_F16, view.width /= 2;
    assert_int_equal(lensprof_deflicker_add(d, &view, &facts, &error), LENSPROF_ERROR_UNSUPPORTED);
    view = frame.view();
    assert_int_equal(lensprof_deflicker_curve(d, nullptr, wanted, 3, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    assert_ok(lensprof_deflicker_curve(d, nullptr, wanted, 2, nullptr, &error));
    lensprof_deflicker_target target = target_to(LENSPROF_TO_LIGHT);
    assert_int_equal(lensprof_deflicker_curve(d, &target, wanted, 2, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    target = target_to(LENSPROF_TO_CURVE);
    assert_int_equal(lensprof_deflicker_curve(d, &target, wanted, 2, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    target = target_to(9);
    assert_int_equal(lensprof_deflicker_curve(d, &target, wanted, 2, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    target = target_to(LENSPROF_TO_SMOOTH), target.window_s = NAN;
    assert_int_equal(lensprof_deflicker_curve(d, &target, wanted, 2, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    lensprof_deflicker_options options;
    lensprof_deflicker_options_init(&options);
    options.region[0] = 0.8, options.region[2] = 0.2, options.region[3] = 1.0;
    lensprof_deflicker *none = nullptr;
    assert_int_equal(lensprof_deflicker_create(&options, &none, &error), LENSPROF_ERROR_ARGUMENT);
    assert_null(none);
    lensprof_deflicker_destroy(nullptr);
}

// Times that repeat, and large ones: whole seconds of a burst, seconds since 1970, thousands of equal times.
void test_times(void **) {
    for (const int rate : {0, 1, 5})
        for (const size_t count : {size_t(40), size_t(3200)}) {
            std::vector<double> times, values;
            uint64_t random = 8;
            for (size_t i = 0; i < count; i++) {
                times.push_back(1.7e9 + (rate ? std::floor(double(i) / rate) : 0.0));
                values.push_back(0.05 * lp_normal(&random));
            }
            const double window = lensprof::best_window(times, values);
            const auto curve = lensprof::smooth_curve(times, values, window);
            for (size_t i = 0; i < count; i++) assert_true(std::abs(curve[i]) < 0.06);
            if (rate) assert_true(window >= 7.0);
        }
}

// One pixel, one row, and all samples at the ends: no crash, and no exposure where there is no information.
void test_small_frames(void **) {
    for (const uint32_t width : {1u, 2u, 3u, 97u})
        for (const uint32_t height : {1u, 2u, 5u})
            for (const uint8_t value : {0, 128, 255}) {
                Deflicker deflicker = make();
                const std::vector<uint8_t> pixels(size_t(width) * height, value);
                const lensprof_image view = {pixels.data(), ptrdiff_t(width),   width,
                                             height,        LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_GREY};
                const bool is_enough = width * height >= 24;
                for (int i = 0; i < 6; i++)
                    assert_int_equal(lensprof_deflicker_add(deflicker.get(), &view, nullptr, nullptr),
                                     is_enough ? LENSPROF_OK : LENSPROF_ERROR_SIZE);
                lensprof_deflicker_result result;
                lensprof_deflicker_result_init(&result);
                const lensprof_status status = lensprof_deflicker_measure(deflicker.get(), &result, nullptr);
                assert_int_equal(status, value == 128 && is_enough ? LENSPROF_OK : LENSPROF_ERROR_NO_SAMPLES);
                if (status == LENSPROF_OK) assert_int_equal(result.levelled, 6);
            }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_flicker_is_measured_and_levelled),
        cmocka_unit_test(test_errors_hold),
        cmocka_unit_test(test_kept_light),
        cmocka_unit_test(test_targets),
        cmocka_unit_test(test_cuts_and_odd_frames),
        cmocka_unit_test(test_slow_movement_and_bumps),
        cmocka_unit_test(test_repeated_frames),
        cmocka_unit_test(test_wrong_response_is_noticed),
        cmocka_unit_test(test_falloff_of_apertures),
        cmocka_unit_test(test_flicker_of_lines),
        cmocka_unit_test(test_curves),
        cmocka_unit_test(test_order_of_calls_and_bad_input),
        cmocka_unit_test(test_times),
        cmocka_unit_test(test_small_frames),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
