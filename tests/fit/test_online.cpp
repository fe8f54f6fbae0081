// A camera that runs: exposures, response and falloff from simulated tracks, what stays unknown, and invalid input.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

extern "C" {
#include "support.h"
}
#undef fail

#include <lensprof/profile.h>

#include "simulated_video.hpp"

static std::size_t allocations = 0;

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
// All of the program's allocations, those of Eigen included.
extern "C" void *__libc_malloc(std::size_t size);
extern "C" void *malloc(std::size_t size) {
    allocations++;
    return __libc_malloc(size);
}
constexpr bool kCounts = true;
#else
constexpr bool kCounts = false;
#endif

namespace {

lensprof_response gamma_curve(double gamma) {
    lensprof_response response;
    assert_ok(lensprof_response_set_gamma(&response, gamma));
    return response;
}

// A run of a camera of gamma 2.2 over some frames, and the exposure of its first frame.
struct Filmed {
    Filmed(const VideoPlan &plan, uint32_t frames, double gamma = 2.2)
        : video(plan, gamma_curve(gamma)), online(options_for(plan)) {
        for (uint32_t f = 0; f < frames; f++) {
            online.add(video, plan.known_sigma, 1);
            if (f == 0) first = video.ev();
        }
        assert_ok(online.status);
    }
    double true_ev() const { return video.ev() - first; }
    Video video;
    OnlineRun online;
    double first = 0.0;
};

// With known exposures, a pan determines everything.
void test_a_pan_with_known_exposures_determines_the_camera(void **) {
    VideoPlan plan;
    plan.known_sigma = 0.1, plan.corner = 0.5;
    const Filmed filmed(plan, 500);
    const lensprof_online_result r = filmed.online.result();
    assert_int_equal(r.known,
                     LENSPROF_ONLINE_KNOWS_EXPONENT | LENSPROF_ONLINE_KNOWS_SHAPE | LENSPROF_ONLINE_KNOWS_FALLOFF);
    assert_close(r.corner, 0.5, 3.0 * r.corner_sigma + 0.003);
    assert_close(std::log(r.gamma / 2.2), 0.0, 3.0 * r.log_gamma_sigma);
    assert_close(filmed.online.exposure.ev, filmed.true_ev(), 3.0 * filmed.online.exposure.ev_sigma);
    assert_true(r.corner_sigma < 0.02 && r.windows >= 3);
    assert_close(r.noise_levels, plan.noise_levels, 0.5);
}

// Every step, by 30 % of wrong tracks: three of four steps within one standard error and a half.
void test_steps_are_right_despite_wrong_tracks(void **) {
    VideoPlan plan;
    plan.outliers = 0.3, plan.known_sigma = 0.1, plan.seed = 3;
    Video video(plan, gamma_curve(2.0));
    OnlineRun online(options_for(plan));
    double before = 0.0, worst = 0.0;
    uint32_t within = 0, count = 0;
    for (uint32_t f = 0; f < 300; f++) {
        online.add(video, plan.known_sigma, 1);
        assert_ok(online.status);
        if (f > 60) {
            const double error = std::abs(online.exposure.step_ev - (video.ev() - before));
            within += error <= 1.5 * online.exposure.step_sigma, count++;
            worst = std::max(worst, error);
        }
        before = video.ev();
    }
    assert_true(within > 3 * count / 4);
    assert_true(worst < 0.06);
    assert_true(online.result().inlier_share < 0.95);
}

// Constant exposure and no known ones: the exponent stays that of the kind of camera, and its error that of the kind.
void test_without_known_exposures_the_exponent_is_unknown(void **) {
    VideoPlan plan;
    plan.ev_range = 0.0;
    const Filmed filmed(plan, 400);
    const lensprof_online_result r = filmed.online.result();
    lensprof_response typical;
    double sigma;
    assert_ok(lensprof_response_set_typical(&typical, LENSPROF_CAMERA_ANY, nullptr, &sigma));
    assert_close(r.log_gamma_sigma, sigma, 1e-9);
    assert_int_equal(r.known & LENSPROF_ONLINE_KNOWS_EXPONENT, 0);
    assert_true(r.corner_sigma > 0.9 * sigma * r.corner * -std::log(r.corner));
    assert_close(filmed.online.exposure.ev, 0.0, 0.02);
}

// A camera that does not move: exposures are known, the falloff is not.
void test_without_motion_the_falloff_is_unknown(void **) {
    VideoPlan plan;
    plan.motion = Motion::still, plan.known_sigma = 0.1;
    const Filmed filmed(plan, 400);
    const lensprof_online_result r = filmed.online.result();
    assert_int_equal(r.known & LENSPROF_ONLINE_KNOWS_FALLOFF, 0);
    assert_true(r.known & LENSPROF_ONLINE_KNOWS_EXPONENT);
    assert_true(r.falloff_sigma > 0.2);
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    assert_ok(lensprof_online_profile(filmed.online.online, &profile, nullptr));
    assert_int_equal(profile.provenance.not_usable, 1);
}

// Linear sensor data: no response to find, and the exponent is 1.
void test_a_linear_camera(void **) {
    VideoPlan plan;
    plan.corner = 0.4;
    lensprof_response linear;
    lensprof_response_set_linear(&linear);
    Video video(plan, linear);
    lensprof_online_options options = options_for(plan);
    options.camera_kind = LENSPROF_CAMERA_LINEAR;
    OnlineRun online(options);
    for (uint32_t f = 0; f < 300; f++) online.add(video, 0.0, 1);
    const lensprof_online_result r = online.result();
    assert_close(r.gamma, 1.0, 1e-9);
    assert_close(r.log_gamma_sigma, 0.0, 0.0);
    assert_close(r.corner, 0.4, 3.0 * r.corner_sigma);
    assert_true(r.corner_sigma < 0.01);
}

// Three channels: white balance follows, and the profile serves all channels.
void test_channels_have_their_own_exposures(void **) {
    VideoPlan plan;
    plan.channels = 3, plan.known_sigma = 0.1, plan.tracks = 200;
    const Filmed filmed(plan, 300);
    const lensprof_online_exposure &e = filmed.online.exposure;
    for (uint32_t c = 0; c < 3; c++) assert_close(std::log2(e.white_balance[c] / filmed.video.balance(c)), 0.0, 0.05);
    assert_true(std::abs(filmed.video.balance(0) - 1.0) > 0.02);
    assert_close(e.ev, filmed.true_ev(), 4.0 * e.ev_sigma);
}

// The profile is the result: its response and falloff, with the same standard error of the corner.
void test_the_profile_is_the_result(void **) {
    VideoPlan plan;
    plan.known_sigma = 0.1, plan.corner = 0.6;
    const Filmed filmed(plan, 400);
    const lensprof_online_result r = filmed.online.result();
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    assert_ok(lensprof_online_profile(filmed.online.online, &profile, nullptr));
    assert_ok(lensprof_profile_validate(&profile));
    double sigma;
    assert_close(lensprof_profile_corner_falloff(&profile, 0, &sigma), r.corner, 0.003);
    assert_close(sigma / r.corner_sigma, 1.0, 0.1);
    const lensprof_response truth = gamma_curve(2.2);
    for (double x : {0.1, 0.3, 0.6, 0.9})
        assert_close(lensprof_response_eval(&profile.response[0], x, nullptr),
                     lensprof_response_eval(&truth, x, nullptr), 0.015);
    assert_string_equal(profile.provenance.method, "online");
    assert_close(profile.provenance.gamma_sigma, r.log_gamma_sigma, 0.0);
}

// From the profile of an earlier run, falloff and response are known before the first frame.
void test_a_run_can_start_from_a_profile(void **) {
    VideoPlan plan;
    plan.known_sigma = 0.1;
    const Filmed filmed(plan, 400);
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    assert_ok(lensprof_online_profile(filmed.online.online, profile.get(), nullptr));
    lensprof_online_options options = options_for(plan);
    options.profile = profile.get();
    const OnlineRun again(options);
    assert_ok(again.status);
    const lensprof_online_result before = filmed.online.result(), after = again.result();
    assert_close(after.corner, before.corner, 0.005);
    assert_close(after.corner_sigma / before.corner_sigma, 1.0, 0.3);
    assert_close(after.gamma / before.gamma, 1.0, 0.01);
    assert_close(after.log_gamma_sigma, before.log_gamma_sigma, 1e-9);
}

// Tracks are lost in one frame and come back: the chain goes on. All new tracks: another one begins.
void test_a_lost_chain_is_stated(void **) {
    VideoPlan plan;
    plan.motion = Motion::handheld, plan.lost = 0.0, plan.outliers = 0.0;
    Video video(plan, gamma_curve(2.2));
    OnlineRun online(options_for(plan));
    const auto add = [&](std::vector<lensprof_online_observation> seen) {
        online.frame.number++, online.frame.count = static_cast<uint32_t>(seen.size()),
                               online.frame.observations = seen.data();
        assert_ok(lensprof_online_add(online.online, &online.frame, &online.exposure, nullptr));
        return online.exposure.state;
    };
    assert_int_equal(add(video.next()), LENSPROF_ONLINE_FIRST);
    assert_true(std::isnan(online.exposure.step_ev));
    assert_int_equal(add(video.next()), LENSPROF_ONLINE_CHAINED);
    assert_int_equal(add({}), LENSPROF_ONLINE_LOST);
    assert_true(std::isnan(online.exposure.ev) && std::isinf(online.exposure.ev_sigma));
    assert_int_equal(add(video.next()), LENSPROF_ONLINE_CHAINED);
    assert_int_equal(online.exposure.before, 2);
    auto others = video.next();
    for (auto &o : others) o.track += 1000000;
    assert_int_equal(add(others), LENSPROF_ONLINE_FIRST);
    assert_int_equal(online.exposure.since, 5);
    const lensprof_online_result r = online.result();
    assert_int_equal(r.chains, 2);
    assert_int_equal(r.lost, 1);
}

// Frames that show something else entirely, small weights and strong noise: the chain goes on afterwards.
void test_noise_is_found_again(void **) {
    for (const float weight : {1.0f, 0.001f}) {
        VideoPlan plan;
        plan.noise_levels = weight < 1.0f ? 2.0 : 40.0;
        Video video(plan, gamma_curve(2.2));
        OnlineRun online(options_for(plan));
        uint32_t chained = 0;
        for (uint32_t f = 0; f < 200; f++) {
            auto seen = video.next();
            for (auto &o : seen) {
                o.weight = weight;
                if (f >= 60 && f < 68) o.value[0] = 0.5f + 0.45f * std::sin(37.0f * static_cast<float>(o.track) + f);
            }
            online.frame.number++, online.frame.count = static_cast<uint32_t>(seen.size()),
                                   online.frame.observations = seen.data();
            assert_ok(lensprof_online_add(online.online, &online.frame, &online.exposure, nullptr));
            uint32_t pending = 0;
            assert_ok(lensprof_online_solve(online.online, 1, &pending, nullptr));
            chained += f >= 80 && online.exposure.state == LENSPROF_ONLINE_CHAINED;
        }
        assert_true(chained >= 110);  // of 120
    }
}

// Cameras and clips that differ: errors lie within the stated ones as often as they should. tests/bench/online.cpp has
// more of them.
void test_stated_errors_are_true(void **) {
    constexpr uint32_t kRuns = 20;
    uint32_t within1 = 0, within3 = 0;
    for (uint32_t i = 0; i < kRuns; i++) {
        VideoPlan plan;
        plan.seed = 100 + i, plan.tracks = 150, plan.known_sigma = 0.1;
        plan.corner = 0.35 + 0.03 * i, plan.motion = i % 2 ? Motion::pan : Motion::forward;
        const Filmed filmed(plan, 300, 1.8 + 0.03 * i);
        const lensprof_online_result r = filmed.online.result();
        const double z = std::abs(r.corner - plan.corner) / r.corner_sigma;
        within1 += z <= 1.0, within3 += z <= 3.0;
        assert_true(r.corner_sigma < 0.08);
    }
    assert_in_range(within1, 8, 18);
    assert_in_range(within3, 19, 20);
}

// The memory has no address, and the same calls give the same bytes.
void test_memory_can_be_copied(void **) {
    VideoPlan plan;
    plan.tracks = 100;
    const lensprof_online_options options = options_for(plan);
    const size_t words = lensprof_online_bytes(&options) / 8 + 1;
    std::vector<uint64_t> memory(words), copy(words);
    lensprof_online *online;
    assert_ok(lensprof_online_begin(memory.data(), words * 8, &options, &online, nullptr));
    Video video(plan, gamma_curve(2.2));
    lensprof_online_frame frame;
    lensprof_online_frame_init(&frame);
    for (uint32_t f = 0; f < 120; f++) {
        if (f == 60) copy = memory;
        const auto &seen = video.next();
        frame.number++, frame.count = static_cast<uint32_t>(seen.size()), frame.observations = seen.data();
        for (auto *each : {&memory, &copy}) {
            if (each == &copy && f < 60) continue;
            auto *camera = reinterpret_cast<lensprof_online *>(each->data());
            assert_ok(lensprof_online_add(camera, &frame, nullptr, nullptr));
            assert_ok(lensprof_online_solve(camera, 1, nullptr, nullptr));
        }
    }
    assert_memory_equal(memory.data(), copy.data(), words * 8);
}

// Frames and solves do not allocate.
void test_frames_take_no_heap(void **) {
    VideoPlan plan;
    plan.known_sigma = 0.1;
    Video video(plan, gamma_curve(2.2));
    const lensprof_online_options options = options_for(plan);
    std::vector<uint64_t> other(lensprof_online_bytes(&options) / 8 + 1);
    lensprof_online *begun;
    const std::size_t at_first = allocations;
    assert_ok(lensprof_online_begin(other.data(), other.size() * 8, &options, &begun, nullptr));
    assert_int_equal(allocations, at_first);
    OnlineRun online(options);
    lensprof_online_frame frame;
    lensprof_online_frame_init(&frame);
    for (uint32_t f = 0; f < 150; f++) {
        const std::vector<lensprof_online_observation> seen = video.next();
        frame.number++, frame.count = static_cast<uint32_t>(seen.size()), frame.observations = seen.data();
        const std::size_t before = allocations;
        assert_ok(lensprof_online_add(online.online, &frame, &online.exposure, nullptr));
        assert_ok(lensprof_online_solve(online.online, 2, nullptr, nullptr));
        assert_int_equal(allocations, before);
    }
    assert_true(online.result().windows > 0 && (allocations > 0 || !kCounts));
}

// Before anything is added there is nothing to solve, and the result is what was known to begin with.
void test_solving_before_any_frame(void **) {
    const OnlineRun online(options_for(VideoPlan()));
    uint32_t pending = 7;
    assert_ok(lensprof_online_solve(online.online, 3, &pending, nullptr));
    assert_int_equal(pending, 0);
    const lensprof_online_result r = online.result();
    assert_int_equal(r.known, 0);
    assert_int_equal(r.frames, 0);
    assert_true(r.corner_sigma > 0.1);
}

void test_invalid_options_are_refused(void **) {
    std::vector<uint64_t> memory(1 << 18);
    lensprof_online *online = nullptr;
    lensprof_error error;
    lensprof_online_options good = options_for(VideoPlan()), bad;
    const auto begin = [&](const lensprof_online_options &o, size_t shift, size_t size) {
        auto *at = reinterpret_cast<char *>(memory.data()) + shift;
        return lensprof_online_begin(at, size, &o, &online, &error);
    };
    const size_t bytes = lensprof_online_bytes(&good);
    assert_int_equal(begin(good, 0, bytes - 1), LENSPROF_ERROR_CAPACITY);
    assert_non_null(std::strstr(error.text, std::to_string(bytes).c_str()));
    assert_int_equal(begin(good, 4, bytes), LENSPROF_ERROR_ARGUMENT);
    const auto refuses = [&](auto change, lensprof_status status) {
        bad = good;
        change(bad);
        assert_int_equal(begin(bad, 0, memory.size() * 8), status);
    };
    refuses([](auto &o) { o.width = 0; }, LENSPROF_ERROR_SIZE);
    refuses([](auto &o) { o.channels = 2; }, LENSPROF_ERROR_ARGUMENT);
    refuses([](auto &o) { o.tracks = 7; }, LENSPROF_ERROR_ARGUMENT);
    refuses([](auto &o) { o.keyframes = 25; }, LENSPROF_ERROR_ARGUMENT);
    refuses([](auto &o) { o.modes = 9; }, LENSPROF_ERROR_ARGUMENT);
    refuses([](auto &o) { o.history = 1; }, LENSPROF_ERROR_ARGUMENT);
    refuses([](auto &o) { o.camera_kind = 6; }, LENSPROF_ERROR_ARGUMENT);
    refuses([](auto &o) { o.center[0] = 0.6; }, LENSPROF_ERROR_ARGUMENT);
    refuses([](auto &o) { o.center[1] = NAN; }, LENSPROF_ERROR_NOT_FINITE);
    refuses([](auto &o) { o.black = 0.95; }, LENSPROF_ERROR_ARGUMENT);
    refuses([](auto &o) { o.struct_size = 4; }, LENSPROF_ERROR_STRUCT_SIZE);
    assert_int_equal(lensprof_online_begin(nullptr, bytes, &good, &online, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_online_begin(memory.data(), bytes, nullptr, &online, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_online_begin(memory.data(), bytes, &good, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    assert_null(online);
    bad = good, bad.tracks = 9000;
    assert_int_equal(lensprof_online_bytes(&bad), 0);
    assert_int_equal(lensprof_online_bytes(nullptr), 0);
}

void test_invalid_frames_are_refused_and_change_nothing(void **) {
    VideoPlan plan;
    plan.tracks = 60;
    const lensprof_online_options options = options_for(plan);
    std::vector<uint64_t> memory(lensprof_online_bytes(&options) / 8 + 1);
    lensprof_online *online;
    assert_ok(lensprof_online_begin(memory.data(), memory.size() * 8, &options, &online, nullptr));
    Video video(plan, gamma_curve(2.2));
    std::vector<lensprof_online_observation> seen = video.next();
    lensprof_online_frame frame;
    lensprof_online_frame_init(&frame);
    frame.number = 10, frame.count = 60, frame.observations = seen.data();
    assert_ok(lensprof_online_add(online, &frame, nullptr, nullptr));
    lensprof_error error;
    const lensprof_online_frame good = frame;
    const auto refuses = [&](auto change, lensprof_status status) {
        seen = video.next();
        frame = good, frame.number = 11, frame.observations = seen.data();
        change();
        lensprof_online_exposure exposure;
        lensprof_online_exposure_init(&exposure);
        assert_int_equal(lensprof_online_add(online, &frame, &exposure, &error), status);
        assert_true(error.text[0] != 0 && exposure.number == 0);
        lensprof_online_result result;
        lensprof_online_result_init(&result);
        assert_ok(lensprof_online_get(online, &result, nullptr));
        assert_int_equal(result.frames, 1);
    };
    refuses([&] { frame.number = 10; }, LENSPROF_ERROR_ARGUMENT);
    refuses([&] { frame.count = 61; }, LENSPROF_ERROR_CAPACITY);
    refuses([&] { frame.observations = nullptr; }, LENSPROF_ERROR_ARGUMENT);
    refuses([&] { frame.known_ev = NAN; }, LENSPROF_ERROR_NOT_FINITE);
    refuses([&] { frame.known_ev = 65.0, frame.known_ev_sigma = 0.1; }, LENSPROF_ERROR_ARGUMENT);
    refuses([&] { frame.known_ev_sigma = -1.0; }, LENSPROF_ERROR_ARGUMENT);
    refuses([&] { frame.struct_size = 8; }, LENSPROF_ERROR_STRUCT_SIZE);
    refuses([&] { seen[7].value[0] = NAN; }, LENSPROF_ERROR_NOT_FINITE);
    assert_int_equal(error.item.kind, LENSPROF_ITEM_OBSERVATION);
    assert_int_equal(error.item.index, 7);
    refuses([&] { seen[7].x = INFINITY; }, LENSPROF_ERROR_NOT_FINITE);
    refuses([&] { seen[7].value[0] = 1.001f; }, LENSPROF_ERROR_ARGUMENT);
    refuses([&] { seen[7].value[0] = -0.001f; }, LENSPROF_ERROR_ARGUMENT);
    refuses([&] { seen[7].x = 639.6f; }, LENSPROF_ERROR_ARGUMENT);
    refuses([&] { seen[7].y = -0.6f; }, LENSPROF_ERROR_ARGUMENT);
    refuses([&] { seen[7].weight = -1.0f; }, LENSPROF_ERROR_ARGUMENT);
    refuses([&] { seen[7].track = seen[3].track; }, LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(error.item.index, 7);
    refuses([&] { seen[7].track = seen[3].track = 1u << 30; }, LENSPROF_ERROR_ARGUMENT);
    seen = video.next();
    frame = good, frame.number = 11, frame.observations = seen.data();
    assert_ok(lensprof_online_add(online, &frame, nullptr, nullptr));
    assert_int_equal(lensprof_online_add(nullptr, &frame, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_online_add(online, nullptr, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    lensprof_online_exposure exposure;
    lensprof_online_exposure_init(&exposure);
    assert_ok(lensprof_online_exposure_at(online, 10, &exposure, nullptr));
    assert_int_equal(exposure.state, LENSPROF_ONLINE_FIRST);
    assert_int_equal(lensprof_online_exposure_at(online, 9, &exposure, nullptr), LENSPROF_ERROR_NOT_FOUND);
}

void test_memory_that_was_not_begun_is_refused(void **) {
    std::vector<uint64_t> empty(1 << 14);
    auto *online = reinterpret_cast<lensprof_online *>(empty.data());
    assert_int_equal(lensprof_online_solve(online, 1, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_pan_with_known_exposures_determines_the_camera),
        cmocka_unit_test(test_steps_are_right_despite_wrong_tracks),
        cmocka_unit_test(test_without_known_exposures_the_exponent_is_unknown),
        cmocka_unit_test(test_without_motion_the_falloff_is_unknown),
        cmocka_unit_test(test_a_linear_camera),
        cmocka_unit_test(test_channels_have_their_own_exposures),
        cmocka_unit_test(test_the_profile_is_the_result),
        cmocka_unit_test(test_a_run_can_start_from_a_profile),
        cmocka_unit_test(test_a_lost_chain_is_stated),
        cmocka_unit_test(test_noise_is_found_again),
        cmocka_unit_test(test_stated_errors_are_true),
        cmocka_unit_test(test_memory_can_be_copied),
        cmocka_unit_test(test_frames_take_no_heap),
        cmocka_unit_test(test_solving_before_any_frame),
        cmocka_unit_test(test_invalid_options_are_refused),
        cmocka_unit_test(test_invalid_frames_are_refused_and_change_nothing),
        cmocka_unit_test(test_memory_that_was_not_begun_is_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
