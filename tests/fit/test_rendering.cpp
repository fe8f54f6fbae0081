// The response from raw frames and pictures rendered of them: the C functions. tests/cli has the accuracy.
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

extern "C" {
#include "support.h"
}
#undef fail

#include <lensprof/rendering.h>

namespace {

constexpr uint32_t kWidth = 320, kHeight = 240;
constexpr double kExponent = 1.0 / 2.2;

// A raw frame, and what a camera with a power function renders of it.
struct Pictures {
    std::vector<uint16_t> raw = std::vector<uint16_t>(size_t(kWidth) * kHeight * 3);
    std::vector<uint8_t> rendered = std::vector<uint8_t>(raw.size());
    lensprof_image raw_view{raw.data(), kWidth * 6, kWidth, kHeight, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB},
        rendered_view{rendered.data(), kWidth * 3, kWidth, kHeight, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};

    explicit Pictures(double phase = 0.0) {
        for (size_t i = 0; i < raw.size(); i++) {
            const double x = double(i / 3 % kWidth), y = double(i / 3 / kWidth);
            const double waves = std::sin(x / 23.0 + phase) * std::cos(y / 31.0 + 2.0 * phase)
                                 + 0.7 * std::sin(x / 61.0 + y / 47.0 + phase)
                                 + 0.2 * std::sin(x / 7.0) * std::sin(y / 9.0);
            const double light = 0.6 * std::exp2(-3.5 + 1.8 * waves) * (i % 3 == 1 ? 1.0 : 0.8);
            raw[i] = static_cast<uint16_t>(65535.0 * std::min(light, 1.0));
            rendered[i] = static_cast<uint8_t>(0.5 + 255.0 * std::pow(std::min(1.4 * light, 1.0), kExponent));
        }
    }
    Pictures(const Pictures &) = delete;
    Pictures &operator=(const Pictures &) = delete;
};

using Held = std::unique_ptr<lensprof_rendering, decltype(&lensprof_rendering_destroy)>;

Held create(lensprof_progress progress = nullptr, void *user = nullptr) {
    lensprof_rendering *made = nullptr;
    assert_ok(lensprof_rendering_create(nullptr, progress, user, &made, nullptr));
    return {made, lensprof_rendering_destroy};
}

lensprof_rendering_result fitted(lensprof_rendering *rendering) {
    lensprof_rendering_result result;
    lensprof_rendering_result_init(&result);
    assert_ok(lensprof_rendering_fit(rendering, &result, nullptr));
    return result;
}

// More shots may be added after a fit; the result is that of all.
void test_shots_are_added_and_fitted_again(void **) {
    const Pictures first, second(1.0);
    const Held rendering = create();
    assert_ok(lensprof_rendering_add(rendering.get(), &first.raw_view, &first.rendered_view, nullptr));
    const lensprof_rendering_result one = fitted(rendering.get());
    assert_close(std::log(one.gamma * kExponent), 0.0, 0.03);
    assert_int_equal(one.shots, 1);
    const lensprof_rendering_result again = fitted(rendering.get());
    assert_memory_equal(&one, &again, sizeof one);
    assert_ok(lensprof_rendering_add(rendering.get(), &second.raw_view, &second.rendered_view, nullptr));
    const lensprof_rendering_result both = fitted(rendering.get());
    assert_int_equal(both.shots, 2);
    assert_true(both.areas > one.areas);
    for (uint32_t i = 0; i < both.findings + both.passed; i++) {
        lensprof_finding finding;
        lensprof_finding_init(&finding);
        assert_ok(lensprof_rendering_finding_at(rendering.get(), i, &finding, nullptr));
        assert_int_equal(finding.severity == LENSPROF_SEVERITY_PASSED, i >= both.findings);
    }
    for (uint32_t i = 0; i < 2; i++) {
        lensprof_rendering_shot shot;
        lensprof_rendering_shot_init(&shot);
        assert_ok(lensprof_rendering_shot_at(rendering.get(), i, &shot, nullptr));
        assert_true(shot.correlation > 0.9 && shot.areas >= 300);
        assert_close(shot.scale, 1.0, 0.01);
    }
}

void test_bad_calls(void **) {
    const Pictures p;
    const Held rendering = create();
    lensprof_error error;
    lensprof_rendering_result result;
    lensprof_rendering_shot shot;
    lensprof_finding finding;
    lensprof_rendering_result_init(&result), lensprof_rendering_shot_init(&shot), lensprof_finding_init(&finding);
    lensprof_rendering *r = rendering.get();
    assert_int_equal(lensprof_rendering_create(nullptr, nullptr, nullptr, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_rendering_add(nullptr, &p.raw_view, &p.rendered_view, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_rendering_add(r, nullptr, &p.rendered_view, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_rendering_add(r, &p.raw_view, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_rendering_add(r, &p.rendered_view, &p.rendered_view, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_rendering_fit(r, &result, &error), LENSPROF_ERROR_NO_SAMPLES);
    assert_int_equal(lensprof_rendering_fit(r, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_rendering_shot_at(r, 0, &shot, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_rendering_finding_at(r, 0, &finding, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_rendering_finding_at(r, 0, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    lensprof_image other = p.raw_view;
    other.row_bytes = 3;
    assert_int_not_equal(lensprof_rendering_add(r, &other, &p.rendered_view, &error), LENSPROF_OK);
    other = p.rendered_view;
    other.width = LENSPROF_RENDERING_SIDE - 1;
    assert_int_equal(lensprof_rendering_add(r, &p.raw_view, &other, &error), LENSPROF_ERROR_SIZE);
    assert_ok(lensprof_rendering_add(r, &p.raw_view, &p.rendered_view, &error));
    result.struct_size = 8;
    assert_int_equal(lensprof_rendering_fit(r, &result, &error), LENSPROF_ERROR_STRUCT_SIZE);
    lensprof_rendering_destroy(nullptr);
}

int stop_at_once(double, void *user) { return ++*static_cast<int *>(user) > 0; }

void test_cancelling_adds_nothing(void **) {
    const Pictures p;
    int calls = 0;
    const Held rendering = create(stop_at_once, &calls);
    lensprof_error error;
    assert_int_equal(lensprof_rendering_add(rendering.get(), &p.raw_view, &p.rendered_view, &error),
                     LENSPROF_ERROR_CANCELLED);
    assert_int_equal(calls, 1);
    lensprof_rendering_shot shot;
    lensprof_rendering_shot_init(&shot);
    assert_int_equal(lensprof_rendering_shot_at(rendering.get(), 0, &shot, &error), LENSPROF_ERROR_ARGUMENT);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shots_are_added_and_fitted_again),
        cmocka_unit_test(test_bad_calls),
        cmocka_unit_test(test_cancelling_adds_nothing),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
