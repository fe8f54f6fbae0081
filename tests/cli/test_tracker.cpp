// Corners that are followed through rendered frames whose motion is known.
#include <cmath>
#include <functional>
#include <map>

#include "picture_files.hpp"

#include "fit/base/quantile.hpp"
#include "photo/video/tracker.hpp"
#include "photo/video/video.hpp"

using namespace picture_files;

namespace {

constexpr uint32_t width = 320, height = 240;

// Light of a wall of soft blobs, 0 to about 1.
double wall_at(double x, double y) {
    double light = 0.42;
    for (int n = 0; n < 5; n++) {
        const double pitch = 7.0 + 5.1 * n, phase = 1.7 * n;
        light += 0.08 * std::sin(x / pitch * 2.3 + phase + std::sin(y / 31.0 + n))
                 * std::cos(y / pitch * 2.1 + 2.0 * phase + std::sin(x / 37.0 - n));
    }
    return light;
}

// A frame's view of the wall: place in the frame to place on the wall.
using View = std::function<std::array<double, 2>(double x, double y)>;

Picture rendered(const View &view, double gain, uint32_t seed) {
    Picture frame;
    frame.width = width, frame.height = height, frame.row_bytes = width;
    frame.layout = LENSPROF_LAYOUT_GREY, frame.sample = LENSPROF_SAMPLE_U8;
    frame.pixels.resize(size_t(width) * height);
    uint32_t state = seed;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const auto [u, v] = view(x, y);
            const double dx = (x - 159.5) / 200.0, dy = (y - 119.5) / 200.0;
            const double light = gain * wall_at(u, v) * (1.0 - 0.45 * (dx * dx + dy * dy));
            state = state * 1664525u + 1013904223u;
            const double level = 255.0 * std::pow(std::min(light, 1.0), 1.0 / 2.2) + (state >> 24) / 128.0 - 0.5;
            frame.pixels[y * frame.row_bytes + x] = static_cast<uint8_t>(std::clamp(level, 0.0, 255.0));
        }
    return frame;
}

struct Followed {
    double error_px = 0.0;  // median distance on the wall from where a place was first seen, of the last frame
    double kept = 0.0;      // share of the places of the first frame that the last one could show
};

Followed follow(const std::function<View(int)> &view_of, int frames) {
    CornerTracker tracker;
    std::map<uint32_t, std::array<double, 2>> first;
    std::vector<double> errors;
    double expected = 0.0, kept = 0.0;
    for (int i = 0; i < frames; i++) {
        const View view = view_of(i);
        const TrackedFrame found = tracker.add(rendered(view, 1.0 + 0.3 * std::sin(i / 5.0), uint32_t(i) + 1));
        for (const TrackedPlace &place : found.places) {
            const auto at = view(double(place.x), double(place.y));
            if (i == 0) first[place.track] = at;
            const auto born = first.find(place.track);
            if (born == first.end() || i + 1 < frames) continue;
            errors.push_back(std::hypot(at[0] - born->second[0], at[1] - born->second[1]));
            kept++;
        }
    }
    const View last = view_of(frames - 1);
    std::vector<std::array<double, 2>> shown;  // the wall in the last frame
    for (const auto &[track, place] : first) {
        double nearest = INFINITY;
        for (double y = 20; y < height - 20.0; y += 4)
            for (double x = 20; x < width - 20.0; x += 4) {
                const auto at = last(x, y);
                nearest = std::min(nearest, std::hypot(at[0] - place[0], at[1] - place[1]));
            }
        expected += nearest < 4.0;
    }
    assert_true(first.size() > 60 && expected > 30.0);
    return {median(errors), kept / expected};
}

// Errors do not add up, although the falloff moves over the corners.
void test_pan(void **) {
    if (!can_read_video()) skip();
    const Followed found = follow(
        [](int i) {
            return [i](double x, double y) -> std::array<double, 2> {
                return {x + 2.3 * i, y + 15.0 * std::sin(i / 9.0)};
            };
        },
        60);
    assert_true(found.error_px < 0.09);
    assert_true(found.kept > 0.8);
}

// A camera that rolls and comes nearer.
void test_roll(void **) {
    if (!can_read_video()) skip();
    const Followed found = follow(
        [](int i) {
            const double turn = 0.012 * i, scale = 1.0 / (1.0 + 0.006 * i);
            return [turn, scale](double x, double y) -> std::array<double, 2> {
                const double dx = scale * (x - 159.5), dy = scale * (y - 119.5);
                return {400.0 + std::cos(turn) * dx - std::sin(turn) * dy,
                        300.0 + std::sin(turn) * dx + std::cos(turn) * dy};
            };
        },
        40);
    assert_true(found.error_px < 0.1);
    assert_true(found.kept > 0.7);
}

// Places end where something else covers them.
void test_cover(void **) {
    if (!can_read_video()) skip();
    CornerTracker tracker;
    std::map<uint32_t, double> first;
    size_t covered = 0, wrong = 0;
    for (int i = 0; i < 30; i++) {
        const double edge = 10.0 * i;  // of what comes from the left
        const View view = [edge](double x, double y) -> std::array<double, 2> {
            return x < edge ? std::array<double, 2>{x - edge + 900.0, y + 500.0} : std::array<double, 2>{x, y};
        };
        const TrackedFrame found = tracker.add(rendered(view, 1.0, uint32_t(i) + 1));
        for (const TrackedPlace &place : found.places) {
            if (i == 0) first[place.track] = double(place.x);
            const auto born = first.find(place.track);
            if (born == first.end() || born->second > edge - 12.0) continue;
            covered++;
            wrong += std::abs(double(place.x) - born->second) < 3.0;
        }
    }
    assert_true(first.size() > 60);
    assert_int_equal(wrong, 0);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pan),
        cmocka_unit_test(test_roll),
        cmocka_unit_test(test_cover),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
