// The tone curve of colour profiles. Damaged profiles give none, and nothing beyond their end is read.
#include "icc_files.hpp"

#include "photo/pictures/icc.hpp"

namespace {

using namespace lensprof;
using namespace icc_files;

ToneCurve told(const Bytes &profile) {
    const std::vector<uint8_t> exact(profile.begin(), profile.end());  // a sanitizer detects reads beyond the end
    return tone_curve_of(exact.data(), exact.size());
}

std::vector<uint32_t> ramp(double exponent, uint32_t bend = 0) {
    std::vector<uint32_t> samples;
    for (int i = 0; i < 256; i++) samples.push_back(uint32_t(std::lround(65535 * std::pow(i / 255.0, exponent))));
    samples[128] += bend;
    return samples;
}

void test_curves(void **) {
    const struct {
        Bytes curve;
        ToneCurve wanted;
    } cases[] = {
        {samples_curve({}), ToneCurve::linear},
        {samples_curve({256}), ToneCurve::linear},
        {samples_curve({563}), ToneCurve::other},  // 2.2
        {samples_curve(ramp(1.0)), ToneCurve::linear},
        {samples_curve(ramp(1.0, 1000)), ToneCurve::other},
        {samples_curve(ramp(1.8)), ToneCurve::other},
        {function_curve(0, {1.0}), ToneCurve::linear},
        {function_curve(0, {2.4}), ToneCurve::other},
        {function_curve(1, {1.0, 1.0, 0.0}), ToneCurve::linear},
        {function_curve(1, {1.0, 2.0, -0.5}), ToneCurve::other},
        {function_curve(2, {1.0, 1.0, 0.0, 0.0}), ToneCurve::linear},
        {function_curve(2, {1.0, 0.9, 0.0, 0.1}), ToneCurve::other},
        {function_curve(3, {1.0, 1.0, 0.0, 1.0, 0.0}), ToneCurve::linear},            // as libjxl writes it
        {function_curve(4, {2.4, 1.0, 0.0, 1.0, 1.5, 0.0, 0.0}), ToneCurve::linear},  // only the linear part
        {function_curve(4, {1.0, 1.0, 0.0, 1.0, 0.0, 0.1, 0.0}), ToneCurve::other},
        {function_curve(5, {1.0}), ToneCurve::unknown},
        {function_curve(3, {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045}), ToneCurve::other},  // sRGB
    };
    for (const auto &one : cases) assert_int_equal(int(told(profile_of(one.curve))), int(one.wanted));
    assert_int_equal(int(told(profile_of(samples_curve({}), {"kTRC"}))), int(ToneCurve::linear));
    assert_int_equal(int(told(profile_of(samples_curve({}), {"wtpt"}))), int(ToneCurve::unknown));
    assert_int_equal(int(told(profile_of(samples_curve({}), {"A2B0", "rTRC"}))), int(ToneCurve::unknown));
    Bytes other = samples_curve({});
    other[0] = 'x';
    assert_int_equal(int(told(profile_of(other))), int(ToneCurve::unknown));
}

void test_damaged(void **) {
    const Bytes whole = profile_of(samples_curve(ramp(1.0)));
    for (size_t bytes = 0; bytes < whole.size(); bytes++)
        assert_int_equal(int(told(Bytes(whole.begin(), whole.begin() + long(bytes)))), int(ToneCurve::unknown));
    for (size_t at : {size_t(128), size_t(136), size_t(140), whole.size() - 512 - 4}) {  // counts, offset, size
        Bytes wrong = whole;
        for (size_t i = 0; i < 4; i++) wrong[at + i] = 0xff;
        assert_int_equal(int(told(wrong)), int(ToneCurve::unknown));
    }
    assert_int_equal(int(tone_curve_of(nullptr, 0)), int(ToneCurve::unknown));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {cmocka_unit_test(test_curves), cmocka_unit_test(test_damaged)};
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
