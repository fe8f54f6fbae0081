// Exposures by the settings of cameras: what cancels, what is known, with which error, and refused input.
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

extern "C" {
#include "support.h"
}
#undef fail

#include <lensprof/exposure_settings.h>

namespace {

using Settings = std::vector<lensprof_exposure_settings>;
using Known = std::vector<lensprof_known_exposure>;

// 1/100 s, f/8, ISO 100.
lensprof_exposure_settings metered() { return {0.01, 8.0, 100.0, 0, 0, 0, 0}; }

lensprof_exposure_settings manual(double time_s = 0.01) { return {time_s, 8.0, 100.0, 0, 0, 1, 0}; }

Known known_of(const Settings &settings) {
    Known known(settings.size());
    lensprof_error error;
    assert_ok(lensprof_known_exposures(settings.data(), static_cast<uint32_t>(settings.size()), known.data(), &error));
    assert_string_equal(error.text, "");
    return known;
}

void assert_sigmas(const Settings &settings, const std::vector<double> &expected) {
    const Known known = known_of(settings);
    for (size_t i = 0; i < known.size(); i++) {
        assert_close(known[i].sigma, expected[i], 1e-12);
        assert_int_equal(known[i].sigma > 0.0, known[i].state == LENSPROF_EXPOSURE_KNOWN);
    }
}

void assert_states(const Settings &settings, const std::vector<uint32_t> &expected) {
    const Known known = known_of(settings);
    for (size_t i = 0; i < known.size(); i++) assert_int_equal(known[i].state, expected[i]);
}

void test_one_stop_is_one_ev(void **) {
    assert_close(lensprof_settings_ev(1.0, 1.0, 100.0), 0.0, 0.0);
    assert_close(lensprof_settings_ev(0.5, 2.0, 400.0), -1.0, 1e-12);
    Settings settings(4, metered());
    settings[1].time_s = 0.02, settings[2].iso = 400.0, settings[3].f_number = 4.0;
    const Known known = known_of(settings);
    assert_close(known[1].ev - known[0].ev, 1.0, 1e-12);
    assert_close(known[2].ev - known[0].ev, 2.0, 1e-12);
    assert_close(known[3].ev - known[0].ev, 2.0, 1e-12);
    assert_close(known[0].ev, lensprof_settings_ev(0.01, 8.0, 100.0), 0.0);
}

// Of several manual exposures that of the most pictures; of equal ones the first. What EXIF rounds is still equal.
void test_manual_exposures_repeat(void **) {
    assert_sigmas({manual(), manual(), manual()}, {0.03, 0.03, 0.03});
    assert_sigmas({manual()}, {0.1});
    assert_sigmas({metered(), metered()}, {0.1, 0.1});
    assert_sigmas({manual(), metered(), manual(0.010005)}, {0.03, 0.1, 0.03});
    assert_sigmas({manual(0.02), manual(), manual(0.02), manual(), manual()}, {0.1, 0.03, 0.1, 0.03, 0.03});
    assert_sigmas({manual(0.02), manual(), manual(0.02), manual()}, {0.03, 0.1, 0.03, 0.1});
    Settings settings(4, manual());
    settings[2].lens = settings[3].lens = 7;
    assert_sigmas(settings, {0.03, 0.03, 0.1, 0.1});
}

void test_what_no_picture_states_cancels(void **) {
    Settings settings(3, metered());
    settings[1].time_s = 0.02;
    for (auto &s : settings) s.f_number = LENSPROF_UNKNOWN;
    assert_sigmas(settings, {0.1, 0.1, 0.1});
    for (auto &s : settings) s.iso = LENSPROF_UNKNOWN;
    assert_sigmas(settings, {0.1, 0.1, 0.1});
    assert_close(known_of(settings)[1].ev - known_of(settings)[0].ev, 1.0, 1e-12);
    for (auto &s : settings) s.time_s = LENSPROF_UNKNOWN;
    assert_states(settings, {LENSPROF_EXPOSURE_NO_TIME, LENSPROF_EXPOSURE_NO_TIME, LENSPROF_EXPOSURE_NO_TIME});
    assert_true(std::isnan(known_of(settings)[0].ev));
}

void test_what_one_picture_lacks_is_unknown(void **) {
    Settings settings(4, metered());
    settings[0].time_s = settings[1].iso = settings[2].f_number = LENSPROF_UNKNOWN;
    assert_states(settings, {LENSPROF_EXPOSURE_NO_TIME, LENSPROF_EXPOSURE_NO_ISO, LENSPROF_EXPOSURE_NO_APERTURE,
                             LENSPROF_EXPOSURE_KNOWN});
    for (const size_t i : {0, 1, 2}) assert_true(std::isnan(known_of(settings)[i].ev));
    settings[1].camera = 1;  // alone on its camera, where ISO cancels
    assert_int_equal(known_of(settings)[1].state, LENSPROF_EXPOSURE_KNOWN);
}

// Pictures of a lens without contacts have another unknown factor than those of a lens with them.
void test_lenses_are_not_compared_without_apertures(void **) {
    Settings settings(5, metered());
    for (const size_t i : {1, 3, 4}) settings[i].lens = 1, settings[i].f_number = LENSPROF_UNKNOWN;
    assert_states(settings, {LENSPROF_EXPOSURE_APART, LENSPROF_EXPOSURE_KNOWN, LENSPROF_EXPOSURE_APART,
                             LENSPROF_EXPOSURE_KNOWN, LENSPROF_EXPOSURE_KNOWN});
    for (const size_t i : {1, 3, 4}) settings[i].camera = 1;
    assert_sigmas(settings, {0.1, 0.1, 0.1, 0.1, 0.1});
}

// Numbers that no camera has are stated, but not used; the other pictures are known as before.
void test_implausible_settings(void **) {
    Settings settings(6, manual());
    settings[0].time_s = 1e-30, settings[1].iso = 0.0, settings[2].f_number = std::nan("");
    settings[3].time_s = std::numeric_limits<double>::infinity(), settings[4].iso = -100.0;
    const Known known = known_of(settings);
    for (size_t i = 0; i < 5; i++) {
        assert_int_equal(known[i].state, LENSPROF_EXPOSURE_IMPLAUSIBLE);
        assert_close(known[i].sigma, 0.0, 0.0);
    }
    assert_int_equal(known[5].state, LENSPROF_EXPOSURE_KNOWN);
}

void assert_refused(const Settings &settings, Known *known, const char *text) {
    lensprof_error error;
    const auto count = static_cast<uint32_t>(settings.size());
    assert_int_equal(lensprof_known_exposures(settings.data(), count, known ? known->data() : nullptr, &error),
                     LENSPROF_ERROR_ARGUMENT);
    assert_true(std::strstr(error.text, text) != nullptr);
    assert_int_equal(lensprof_known_exposures(settings.data(), count, known ? known->data() : nullptr, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
}

void test_bad_input_changes_nothing(void **) {
    Known known(2, {7.0, 7.0, 7, 7});
    Settings settings(2, metered());
    settings[1].is_manual = 2;
    assert_refused(settings, &known, "image 1: is_manual must be 0 or 1");
    settings[1].is_manual = 0, settings[1].reserved = 1;
    assert_refused(settings, &known, "reserved 0");
    assert_close(known[0].ev, 7.0, 0.0);
    settings[1].reserved = 0;
    assert_refused(settings, nullptr, "NULL");
    lensprof_error error;
    assert_int_equal(lensprof_known_exposures(nullptr, 2, known.data(), &error), LENSPROF_ERROR_ARGUMENT);
    assert_ok(lensprof_known_exposures(nullptr, 0, nullptr, &error));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_one_stop_is_one_ev),
        cmocka_unit_test(test_manual_exposures_repeat),
        cmocka_unit_test(test_what_no_picture_states_cancels),
        cmocka_unit_test(test_what_one_picture_lacks_is_unknown),
        cmocka_unit_test(test_lenses_are_not_compared_without_apertures),
        cmocka_unit_test(test_implausible_settings),
        cmocka_unit_test(test_bad_input_changes_nothing),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
