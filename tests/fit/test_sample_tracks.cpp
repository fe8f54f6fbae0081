// Sampling of tracks: every observation of a point shows it, points are spread evenly, saturated observations are kept.
#include "sampled_pictures.hpp"

#include <algorithm>
#include <map>

namespace {

using Tracks = std::map<uint32_t, std::vector<lensprof_observation>>;

Tracks tracks_of(const std::vector<lensprof_observation> &observations) {
    Tracks tracks;
    for (const auto &o : observations) tracks[o.point].push_back(o);
    return tracks;
}

// Longitude and latitude of an observation, according to a camera.
void direction_of(const lensprof_camera &camera, const lensprof_observation &o, double direction[2]) {
    assert_true(lensprof_camera_unproject(&camera, o.xy[0], o.xy[1], direction));
}

void test_observations_show_one_point(void **) {
    for (uint32_t sampling : {LENSPROF_SAMPLING_BALANCED, LENSPROF_SAMPLING_PAPER}) {
        Pictures pictures(5, 320, 240, 12.0);
        std::vector<lensprof_observation> observations;
        assert_ok(pictures.tracks(options_of(sampling, 500), observations));
        Tracks tracks = tracks_of(observations);
        assert_int_equal(tracks.size(), 500);
        size_t longest = 0;
        for (const auto &track : tracks) {
            double first[2], next[2];
            direction_of(pictures.images[track.second[0].image].camera, track.second[0], first);
            std::vector<uint32_t> images;
            for (const auto &o : track.second) {
                direction_of(pictures.images[o.image].camera, o, next);
                assert_close(next[0], first[0], 1e-7);
                assert_close(next[1], first[1], 1e-7);
                for (int c = 0; c < 3; c++) assert_close(o.value[c], scene(first[0], first[1], c), 0.004);
                images.push_back(o.image);
            }
            std::sort(images.begin(), images.end());
            assert_true(std::unique(images.begin(), images.end()) == images.end());
            assert_true(images.size() >= 2);
            longest = std::max(longest, images.size());
        }
        assert_true(longest >= 4);  // 50 degrees wide, 12 apart
    }
}

// Equal areas that two or more pictures see hold equally many points.
void test_points_are_spread_evenly(void **) {
    Pictures pictures(5, 320, 240, 12.0);
    std::vector<lensprof_observation> observations;
    assert_ok(pictures.tracks(options_of(LENSPROF_SAMPLING_BALANCED, 2000), observations));
    const double left = -0.1, right = 0.9, low = -0.25, high = 0.25;  // radians; sin of latitude: all are seen twice
    int cells[10][5] = {}, inside = 0;
    for (const auto &track : tracks_of(observations)) {
        double d[2];
        direction_of(pictures.images[track.second[0].image].camera, track.second[0], d);
        int column = static_cast<int>(std::floor(10 * (d[0] - left) / (right - left)));
        int row = static_cast<int>(std::floor(5 * (std::sin(d[1]) - low) / (high - low)));
        if (column < 0 || column >= 10 || row < 0 || row >= 5) continue;
        cells[column][row]++, inside++;
    }
    assert_true(inside > 700);
    for (auto &column : cells)
        for (int count : column) {
            assert_true(count * 50 > inside / 3);
            assert_true(count * 50 < inside * 3);
        }
}

// A bright window: saturated in all channels, in one channel, and in part of a patch.
void test_saturated_patches_are_kept(void **) {
    Pictures pictures(3, 320, 240, 12.0);
    auto &data = pictures.data[1];
    for (uint32_t v = 60; v < 180; v++)
        for (uint32_t u = 100; u < 220; u++) {
            float *pixel = &data[(v * 320 + u) * 3];
            pixel[0] = 1.0f;
            if (v < 120) pixel[1] = pixel[2] = 1.0f;
        }
    for (uint32_t sampling : {LENSPROF_SAMPLING_BALANCED, LENSPROF_SAMPLING_PAPER}) {
        std::vector<lensprof_observation> observations;
        assert_ok(pictures.tracks(options_of(sampling, 1500), observations));
        size_t white = 0, red = 0;
        for (const auto &o : observations) {
            bool window = o.image == 1 && o.xy[0] > 103 && o.xy[0] < 216 && o.xy[1] > 63 && o.xy[1] < 176;
            bool upper = window && o.xy[1] < 116, lower = window && o.xy[1] > 123;
            if (upper) white++, assert_true(o.value[0] == 1.0 && o.value[1] == 1.0 && o.value[2] == 1.0);
            if (lower) red++, assert_true(o.value[0] == 1.0 && o.value[1] <= 0.98 && o.value[2] <= 0.98);
            for (double value : o.value) assert_true((value >= 0.02 && value <= 0.98) || value == 1.0);
        }
        assert_true(white > 10 && red > 10);
        for (const auto &track : tracks_of(observations))
            assert_true(std::any_of(track.second.begin(), track.second.end(), [](const lensprof_observation &o) {
                return *std::max_element(o.value, o.value + 3) < 1.0;
            }));
    }
}

// Something covers the scene in one picture: its observations are missing, the others are present.
void test_what_moved_is_left_out(void **) {
    detail = 0.07;
    Pictures pictures(3, 320, 240, 12.0);
    detail = 0.0;
    for (uint32_t v = 60; v < 180; v++)
        for (uint32_t u = 60; u < 180; u++)
            for (uint32_t c = 0; c < 3; c++) pictures.data[1][(v * 320 + u) * 3 + c] = 0.6f;
    auto share_inside = [&](uint32_t sampling) {
        std::vector<lensprof_observation> observations;
        assert_ok(pictures.tracks(options_of(sampling, 1000), observations));
        double inside = 0.0;
        for (const auto &o : observations)
            inside += o.image == 1 && o.xy[0] > 72 && o.xy[0] < 168 && o.xy[1] > 72 && o.xy[1] < 168;
        return inside / static_cast<double>(observations.size());
    };
    assert_true(share_inside(LENSPROF_SAMPLING_PAPER) > 0.04);
    assert_true(share_inside(LENSPROF_SAMPLING_BALANCED) < 0.02);
}

// The second picture was taken in another direction than the project states.
void test_a_project_that_is_off_is_registered(void **) {
    detail = 0.07;
    Pictures pictures(2, 320, 240, 15.0);
    detail = 0.0;
    const lensprof_camera truth[2] = {pictures.images[0].camera, pictures.images[1].camera};
    pictures.images[1].camera.yaw_deg += 1.0;
    pictures.images[1].camera.pitch_deg += 0.7;
    std::vector<lensprof_observation> observations;
    assert_ok(pictures.tracks(options_of(LENSPROF_SAMPLING_BALANCED, 500), observations));
    std::vector<double> off;
    for (const auto &track : tracks_of(observations)) {
        double direction[2], xy[2];
        direction_of(truth[track.second[0].image], track.second[0], direction);
        assert_true(lensprof_camera_project(&truth[track.second[1].image], direction[0], direction[1], xy));
        off.push_back(std::hypot(xy[0] - track.second[1].xy[0], xy[1] - track.second[1].xy[1]));
    }
    std::sort(off.begin(), off.end());
    assert_true(off[off.size() * 95 / 100] < 1.5);
}

void test_any_number_of_threads_gives_the_same_tracks(void **) {
    Pictures pictures(4, 160, 120, 15.0);
    for (uint32_t sampling : {LENSPROF_SAMPLING_BALANCED, LENSPROF_SAMPLING_PAPER}) {
        std::vector<lensprof_observation> one, more;
        lensprof_sample_options options = options_of(sampling, 400);
        options.threads = 1;
        assert_ok(pictures.tracks(options, one));
        for (uint32_t threads : {2u, 5u}) {
            options.threads = threads;
            assert_ok(pictures.tracks(options, more));
            assert_int_equal(more.size(), one.size());
            assert_memory_equal(more.data(), one.data(), one.size() * sizeof one[0]);
        }
        options.seed = 2;
        assert_ok(pictures.tracks(options, more));
        assert_true(more.size() != one.size() || std::memcmp(more.data(), one.data(), one.size() * sizeof one[0]) != 0);
    }
}

void test_progress_and_cancel(void **) {
    Pictures pictures(3, 160, 120, 15.0);
    for (size_t last : {size_t{2}, SIZE_MAX}) {
        struct Heard {
            std::vector<double> done;
            size_t last;
        } heard{{}, last};
        lensprof_sample_options options = options_of(LENSPROF_SAMPLING_BALANCED, 500);
        options.progress = [](double done, void *user) {
            auto *h = static_cast<Heard *>(user);
            h->done.push_back(done);
            return static_cast<int>(h->done.size() >= h->last);
        };
        options.progress_user = &heard;
        std::vector<lensprof_observation> observations;
        assert_int_equal(pictures.tracks(options, observations), last == 2 ? LENSPROF_ERROR_CANCELLED : LENSPROF_OK);
        assert_true(std::is_sorted(heard.done.begin(), heard.done.end()));
        if (last != 2) assert_true(heard.done.back() == 1.0);
    }
}

void test_refuses(void **) {
    std::vector<lensprof_observation> observations;
    lensprof_error error;
    lensprof_sample_options options = options_of(LENSPROF_SAMPLING_BALANCED, 100);
    Pictures apart(2, 80, 60, 90.0);
    assert_int_equal(apart.tracks(options, observations, &error), LENSPROF_ERROR_NO_OVERLAP);
    Pictures white(2, 80, 60, 20.0);
    for (auto &picture : white.data) std::fill(picture.begin(), picture.end(), 1.0f);
    assert_int_equal(white.tracks(options, observations, &error), LENSPROF_ERROR_NO_SAMPLES);
    Pictures nan(2, 80, 60, 20.0);
    nan.data[1][(7 * 80 + 5) * 3] = NAN;
    assert_int_equal(nan.tracks(options, observations, &error), LENSPROF_ERROR_NOT_FINITE);
    Pictures good(2, 80, 60, 20.0);
    uint32_t found = 0;
    lensprof_observation few[10];
    assert_int_equal(lensprof_sample_tracks(&options, good.images.data(), 2, few, 10, &found, &error),
                     LENSPROF_ERROR_CAPACITY);
    assert_int_equal(lensprof_sample_tracks(&options, good.images.data(), 2, nullptr, 10, &found, &error),
                     LENSPROF_ERROR_ARGUMENT);
    assert_ok(lensprof_sample_tracks(&options, good.images.data(), 2, nullptr, 0, &found, &error));
    assert_int_equal(found, 200);
    good.images.resize(1);
    assert_int_equal(good.tracks(options, observations, &error), LENSPROF_ERROR_ARGUMENT);
    options.struct_size = 3;
    assert_int_equal(apart.tracks(options, observations, &error), LENSPROF_ERROR_STRUCT_SIZE);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_observations_show_one_point),
        cmocka_unit_test(test_points_are_spread_evenly),
        cmocka_unit_test(test_saturated_patches_are_kept),
        cmocka_unit_test(test_what_moved_is_left_out),
        cmocka_unit_test(test_a_project_that_is_off_is_registered),
        cmocka_unit_test(test_any_number_of_threads_gives_the_same_tracks),
        cmocka_unit_test(test_progress_and_cancel),
        cmocka_unit_test(test_refuses),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
