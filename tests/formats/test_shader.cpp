// Profiles as source code: comments and numbers, and what is refused. The code itself is compiled and run by
// tests/python/test_export.py.
#include <cmath>

#include "formats/code/code_text.hpp"
#include "formats/code/shader_table.hpp"
#include "formats/text/text.hpp"
#include "profile_support.hpp"

using namespace lensprof;

namespace {

std::string exported(const lensprof_profile &profile, uint32_t format, lensprof_status *status = nullptr,
                     std::string *why = nullptr) {
    lensprof_export_options options;
    lensprof_export_options_init(&options);
    options.format = format;
    const lensprof_profile *pointer = &profile;
    return written(
        [&](void *text, size_t capacity, size_t *needed, lensprof_error *error) {
            return lensprof_export(&pointer, 1, &options, text, capacity, needed, error);
        },
        status, why);
}

void test_comments(void **) {
    const std::pair<const char *, const char *> cases[] = {
        {"", ""},
        {"Canon EF 50mm f/1.8", "Canon EF 50mm f/1.8"},
        {"*/", "* /"},
        {"**//*", "** / / *"},
        {"//", "/ /"},
        {"\?\?/", "? ?/"},
        {"a\nb\r\tc\x7f", "a_b__c_"},
        {"a\\", "a_"},
        {"\xC3\xA9\xE6\x97\xA5\xF0\x9F\x93\xB7", "\xC3\xA9\xE6\x97\xA5\xF0\x9F\x93\xB7"},
        {"\xE2\x80\x93 \xE2\x80\x99 \xE2\x82\xAC", "\xE2\x80\x93 \xE2\x80\x99 \xE2\x82\xAC"},
        {"\xC2\x85\xE2\x80\xA8\xE2\x80\xA9", "___"},
        {"\xE2\x80\xAE\xE2\x81\xA6\xE2\x80\x8F\xEF\xBB\xBF", "____"},
        {"\xFF\xC3(\xE2\x80", "__(__"},
        {"*\xFF/", "*_/"},
    };
    for (const auto &[text, safe] : cases) assert_string_equal(comment_text(text).c_str(), safe);
    uint64_t random = 3;
    for (int round = 0; round < 2000; round++) {
        std::string text;
        const char signs[] = "/*\\?\n\x85\xE2\x80\xA8 a";
        for (int i = 0; i < 20; i++) text += signs[static_cast<size_t>(lp_random(&random) * (sizeof signs - 1))];
        const std::string safe = comment_text(text);
        for (const char *bad : {"*/", "/*", "//", "\\", "\n", "\?\?", "\xE2\x80\xA8"})
            assert_true(safe.find(bad) == std::string::npos);
        assert_int_equal(find_not_utf8(safe), safe.size());
    }
}

void test_numbers(void **) {
    const std::pair<double, const char *> cases[] = {{0, "0.0"},       {-0.0, "0.0"}, {1, "1.0"},     {-0.25, "-0.25"},
                                                     {1e-12, "1e-12"}, {0.1, "0.1"},  {1e6, "1e+06"}, {255, "255.0"}};
    for (const auto &[value, text] : cases) assert_string_equal(float_text(value).c_str(), text);
    assert_string_equal(fixed_text(1e-12).c_str(), "0.000000000001");
    assert_string_equal(fixed_text(-0.0).c_str(), "0");
}

void test_name_of_profile(void **) {
    const Profile p = new_profile();
    assert_string_equal(name_of_profile(p->key).c_str(), "");
    p->key.aperture = 2.8;
    assert_string_equal(name_of_profile(p->key).c_str(), "f/2.8");
    snprintf(p->key.camera_model, sizeof p->key.camera_model, "X1");
    snprintf(p->key.lens, sizeof p->key.lens, "Acme 50mm");
    p->key.focal_mm = 50, p->key.distance_m = INFINITY;
    assert_string_equal(name_of_profile(p->key).c_str(), "X1, Acme 50mm, 50 mm, f/2.8, infinity");
    assert_true(exported(*p, LENSPROF_FORMAT_GLSL).find("// Profile: X1, Acme 50mm, 50 mm, f/2.8, infinity\n")
                != std::string::npos);
}

// The shortest table that is good enough; the longest one is, whatever the response.
void test_table(void **) {
    const Profile p = new_profile();
    p->vignetting[0] = {{-0.35, 0.1, -0.1}, {0.05, 0}};
    lensprof_response_set_srgb(&p->response[0]);
    const ShaderTable smooth = shader_table(*p);
    assert_int_equal(smooth.values.size(), 1);
    assert_true(smooth.values[0].size() == 65 && smooth.worst < 0.3 && smooth.worst > 0.0);
    uint64_t random = 9;
    size_t longest = 0;
    for (int round = 0; round < 20; round++) {
        double table[LENSPROF_RESPONSE_SAMPLES] = {0};
        for (int i = 1; i < LENSPROF_RESPONSE_SAMPLES; i++)  // few steps, some of them high
            table[i] =
                table[i - 1] + (lp_random(&random) < 0.05 ? pow(lp_random(&random), 6) : 0.0) + (i == 1023 ? 0.01 : 0);
        for (double &value : table) value /= table[1023];
        assert_ok(lensprof_response_set_table(&p->response[0], table, LENSPROF_RESPONSE_SAMPLES));
        const ShaderTable rough = shader_table(*p);
        assert_true(rough.worst < 0.3);
        longest = std::max(longest, rough.values[0].size());
    }
    assert_int_equal(longest, 1021);
}

void test_refused(void **) {
    lensprof_status status;
    std::string why;
    const Profile p = new_profile();
    p->grid.columns = p->grid.rows = 2, p->grid.channels = 1;
    for (int i = 0; i < 4; i++) p->grid.attenuation[i] = 0.9f;
    for (const uint32_t format : {LENSPROF_FORMAT_GLSL, LENSPROF_FORMAT_WGSL}) {
        exported(*p, format, &status, &why);
        assert_int_equal(status, LENSPROF_ERROR_UNSUPPORTED);
        assert_int_equal(
            why.find(std::string("profile 0: has a gain grid, which ") + lensprof_format_get_info(format)->name), 0);
    }
    assert_true(exported(*p, LENSPROF_FORMAT_C).find("gain grid, which only the blob holds") != std::string::npos);
    assert_int_equal(lp_shader_write(p.get(), LENSPROF_FORMAT_C, nullptr, 0, nullptr, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_shader_write(nullptr, LENSPROF_FORMAT_GLSL, nullptr, 0, nullptr, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_c_header_write(nullptr, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    p->response[0].table[3] = NAN;
    assert_int_equal(lp_shader_write(p.get(), LENSPROF_FORMAT_GLSL, nullptr, 0, nullptr, nullptr),
                     LENSPROF_ERROR_RESPONSE);
    assert_int_equal(lp_c_header_write(p.get(), nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_RESPONSE);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_comments), cmocka_unit_test(test_numbers), cmocka_unit_test(test_name_of_profile),
        cmocka_unit_test(test_table),    cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
