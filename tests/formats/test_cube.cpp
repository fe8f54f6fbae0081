// Responses as one-dimensional cubes. FFmpeg's reader: tests/python/test_export.py.
#include <algorithm>

#include "profile_support.hpp"

namespace {

struct Curves {
    lensprof_status status;
    std::string error;
    uint32_t count;
    lensprof_response response[3];
};

std::unique_ptr<Curves> read(const std::string &text, uint32_t curve = LENSPROF_CURVE_INVERSE) {
    auto curves = std::make_unique<Curves>();
    lensprof_error error;
    const std::vector<char> bytes = exact(text);
    curves->count = 99;
    curves->status = lp_cube_read(bytes.data(), bytes.size(), curve, curves->response, &curves->count, &error);
    curves->error = error.text;
    assert_true((curves->status == LENSPROF_OK) == curves->error.empty());
    assert_true(curves->status == LENSPROF_OK || curves->count == 99);
    return curves;
}

std::string write(const lensprof_profile &profile, uint32_t curve, uint32_t rows) {
    return written([&](void *text, size_t capacity, size_t *needed, lensprof_error *error) {
        return lp_cube_write(&profile, curve, rows, text, capacity, needed, error);
    });
}

double at(const Curves &curves, int channel, double x) {
    return lensprof_response_eval(&curves.response[channel], x, nullptr);
}

size_t longest_line(const std::string &text) {
    size_t longest = 0;
    for (size_t begin = 0, end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
        longest = std::max(longest, end - begin);
    return longest;
}

const char kRows[] = "0 0 0\n0.25 0.5 0.75\n1 1 1\n";

// Files of Adobe's programs, of Resolve, and with what the format allows around the rows.
void test_layouts(void **) {
    for (const char *head :
         {"LUT_1D_SIZE 3\n", "TITLE \"LUT_3D_SIZE 5\"\nLUT_1D_SIZE 3\nDOMAIN_MIN 0.0 0 0\nDOMAIN_MAX 1.0 1 1\n",
          "# a comment\r\n\r\nDOMAIN_MAX 1 1 1e0\r\nDOMAIN_MIN -0 0 0\r\nLUT_1D_SIZE\t3 \r\n",
          "\xEF\xBB\xBFTITLE \"x\"\nLUT_1D_SIZE 3\nLUT_1D_INPUT_RANGE 0.0 1.0\n# more\n\n"}) {
        const auto curves = read(head + std::string(kRows) + "# the end\n \n");
        assert_string_equal(curves->error.c_str(), "");
        assert_int_equal(curves->count, 3);
        for (int c = 0; c < 3; c++) assert_close(at(*curves, c, 0.25 * (c + 1)), 0.5, 1e-3);
        assert_int_equal(lensprof_format_detect(head, strlen(head), nullptr), LENSPROF_FORMAT_CUBE);
    }
    assert_int_equal(read("LUT_1D_SIZE 2\n0 0 0\n 3\t3  3")->count, 1);
    const auto forward = read("LUT_1D_SIZE 3\n16 16 16\n116 116 116\n216 216 216\n", LENSPROF_CURVE_FORWARD);
    assert_close(at(*forward, 0, 0.25), 0.25, 1e-12);
}

void test_round_trip(void **) {
    const auto profile = new_profile();
    const double emor[2] = {0.3, -0.1};
    assert_ok(lensprof_response_set_emor(&profile->response[0], emor, 2));
    assert_ok(lensprof_response_set_gamma(&profile->response[1], 10));
    assert_ok(lensprof_response_set_gamma(&profile->response[2], 0.5));
    for (const uint32_t responses : {1u, 3u})
        for (const uint32_t curve : {LENSPROF_CURVE_INVERSE, LENSPROF_CURVE_FORWARD}) {
            profile->responses = responses;
            const std::string text = write(*profile, curve, 4096);
            const auto again = read(text, curve);
            assert_string_equal(again->error.c_str(), "");
            assert_int_equal(again->count, responses);
            for (uint32_t c = 0; c < responses; c++)
                for (int i = 1; i <= 100; i++)  // a forward table is coarse where the response is steep
                    if (c != 1 || (curve == LENSPROF_CURVE_INVERSE && i > 1))
                        assert_close(at(*again, static_cast<int>(c), i / 100.0),
                                     lensprof_response_eval(&profile->response[c], i / 100.0, nullptr), 1e-3);
            assert_true(text.find('e', text.find("DOMAIN")) == std::string::npos);  // numbers have no exponent
            assert_true(longest_line(text) <= 250);
        }
}

void test_title(void **) {
    const auto profile = new_profile();
    snprintf(profile->key.lens, sizeof profile->key.lens, "50mm \"fast\" \xFF\xC3\xA9");
    profile->key.focal_mm = 50;
    const std::string text = write(*profile, LENSPROF_CURVE_INVERSE, 2);
    assert_string_equal(text.c_str(),
                        "TITLE \"lensprof: grey values into light, 50mm _fast_ ___, 50 mm\"\nLUT_1D_SIZE 2\n"
                        "DOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 1 1\n0 0 0\n1 1 1\n");
    assert_int_equal(write(*profile, LENSPROF_CURVE_FORWARD, 2).find("TITLE \"lensprof: light into grey values"), 0);
}

void test_refused(void **) {
    const std::string size = "LUT_1D_SIZE 3\n", rows = kRows;
    const struct {
        std::string text;
        lensprof_status status;
        const char *words;
        uint32_t curve;
    } cases[] = {
        {"", LENSPROF_ERROR_SYNTAX, "no LUT_1D_SIZE", 0},
        {"# nothing\n", LENSPROF_ERROR_SYNTAX, "no LUT_1D_SIZE", 0},
        {rows, LENSPROF_ERROR_SYNTAX, "line 1: a row before LUT_1D_SIZE", 0},
        {"TITLE \"a\"\nLUT_3D_SIZE 2\n", LENSPROF_ERROR_UNSUPPORTED, "line 2: LUT_3D_SIZE", 0},
        {size + rows + "LUT_3D_SIZE 2\n", LENSPROF_ERROR_UNSUPPORTED, "LUT_3D_SIZE", 0},
        {size + "DOMAIN_MAX 2 2 2\n" + rows, LENSPROF_ERROR_UNSUPPORTED, "line 2: DOMAIN_MAX", 0},
        {size + "DOMAIN_MIN 0 0.1 0\n" + rows, LENSPROF_ERROR_UNSUPPORTED, "line 2: DOMAIN_MIN", 0},
        {size + "LUT_1D_INPUT_RANGE 0 4\n" + rows, LENSPROF_ERROR_UNSUPPORTED, "line 2: LUT_1D_INPUT_RANGE", 0},
        {size + "DOMAIN_MIN 0\n" + rows, LENSPROF_ERROR_SYNTAX, "line 2: DOMAIN_MIN has 1 numbers, not 3", 0},
        {size + "DOMAIN_MIN 0 x 0\n" + rows, LENSPROF_ERROR_SYNTAX, "line 2: \"x\" is not a finite number", 0},
        {size + rows + "DOMAIN_MIN 0 0 0\n", LENSPROF_ERROR_SYNTAX, "line 5: \"DOMAIN_MIN\" after the first row", 0},
        {size + size + rows, LENSPROF_ERROR_SYNTAX, "line 2: a second LUT_1D_SIZE", 0},
        {"LUT_1D_SIZE 1\n0 0 0\n", LENSPROF_ERROR_SYNTAX, "line 1: LUT_1D_SIZE is not a whole number", 0},
        {"LUT_1D_SIZE 2.5\n", LENSPROF_ERROR_SYNTAX, "line 1: LUT_1D_SIZE is not a whole number", 0},
        {"LUT_1D_SIZE\n", LENSPROF_ERROR_SYNTAX, "line 1: LUT_1D_SIZE is not a whole number", 0},
        {"LUT_1D_SIZE -1e300\n", LENSPROF_ERROR_SYNTAX, "line 1: LUT_1D_SIZE is not a whole number", 0},
        {"LUT_1D_SIZE 65537\n", LENSPROF_ERROR_SIZE, "line 1: LUT_1D_SIZE is over 65536", 0},
        {"LUT_1D_SIZE 1e300\n", LENSPROF_ERROR_SIZE, "line 1: LUT_1D_SIZE is over 65536", 0},
        {"LUT_1D_SIZE 4\n" + rows, LENSPROF_ERROR_SYNTAX, "3 rows, but LUT_1D_SIZE is 4", 0},
        {"LUT_1D_SIZE 2\n" + rows, LENSPROF_ERROR_SYNTAX, "line 4: more than the 2 rows", 0},
        {size + "0 0\n", LENSPROF_ERROR_SYNTAX, "line 2: 2 numbers instead of 3", 0},
        {size + "0 0 nan\n", LENSPROF_ERROR_SYNTAX, "line 2: \"nan\"", 0},
        {size + "nan 0 0\n", LENSPROF_ERROR_SYNTAX, "line 2: \"nan\"", 0},
        {size + "GAMMA 2\n" + rows, LENSPROF_ERROR_SYNTAX, "line 2: \"GAMMA\" is not a word of the format", 0},
        {size + "1 1 1\n0 0 0\n1 1 1\n", LENSPROF_ERROR_RESPONSE, "line 3: 0 is below the 1 before it", 0},
        {size + "-1 0 0\n0 0 0\n1 1 1\n", LENSPROF_ERROR_RESPONSE, "line 2: -1 is below 0", 0},
        {size + rows, LENSPROF_ERROR_UNSUPPORTED, "choose the inverse or forward curve", LENSPROF_CURVE_LOG},
        {size + rows, LENSPROF_ERROR_UNSUPPORTED, "choose the inverse or forward curve", LENSPROF_CURVE_LOG10},
        {size + rows, LENSPROF_ERROR_UNSUPPORTED, "choose the inverse or forward curve", 99},
        {std::string((64u << 20) + 1, '\n'), LENSPROF_ERROR_SIZE, "64 MiB", 0},
    };
    for (const auto &c : cases) {
        const auto curves = read(c.text, c.curve);
        if (curves->error.find(c.words) == std::string::npos)
            fail_msg("\"%s\" instead of \"%s\"", curves->error.c_str(), c.words);
        assert_int_equal(curves->status, c.status);
    }
}

void test_arguments(void **) {
    const auto profile = new_profile();
    lensprof_response *r = profile->response;
    uint32_t count;
    lensprof_error error;
    assert_int_equal(lp_cube_read("1", 1, 0, nullptr, &count, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_cube_read("1", 1, 0, r, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_cube_write(nullptr, 0, 256, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    for (const uint32_t rows : {0u, 1u, 65537u})
        assert_int_equal(lp_cube_write(profile.get(), 0, rows, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_cube_write(profile.get(), 4, 256, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    for (const uint32_t curve : {LENSPROF_CURVE_LOG, LENSPROF_CURVE_LOG10}) {
        assert_int_equal(lp_cube_write(profile.get(), curve, 256, nullptr, 0, nullptr, &error),
                         LENSPROF_ERROR_UNSUPPORTED);
        assert_non_null(strstr(error.text, "choose the inverse or forward curve"));
    }
    r[0].table[3] = NAN;
    assert_int_equal(lp_cube_write(profile.get(), 0, 256, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_RESPONSE);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_layouts), cmocka_unit_test(test_round_trip), cmocka_unit_test(test_title),
        cmocka_unit_test(test_refused), cmocka_unit_test(test_arguments),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
