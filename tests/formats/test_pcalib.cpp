// TUM's pcalib.txt.
#include <cfloat>
#include <sstream>

#include "profile_support.hpp"

namespace {

lensprof_status read_pcalib(const std::string &text, lensprof_response *response, std::string *why = nullptr) {
    lensprof_error error;
    const std::vector<char> bytes = exact(text);
    const lensprof_status status = lp_pcalib_read(bytes.data(), bytes.size(), response, &error);
    if (why) *why = error.text;
    return status;
}

std::string write_pcalib(const lensprof_response &response) {
    return written([&](void *text, size_t capacity, size_t *needed, lensprof_error *error) {
        return lp_pcalib_write(&response, text, capacity, needed, error);
    });
}

std::vector<double> numbers(const std::string &text) {
    std::istringstream in(text);
    std::vector<double> values;
    for (double value; in >> value;) values.push_back(value);
    return values;
}

std::string gamma_text(double gamma, int count, double low, double high) {
    std::string text;
    char word[40];
    for (int i = 0; i < count; i++) {
        snprintf(word, sizeof word, "%.15g%s", low + (high - low) * pow(i / (count - 1.0), gamma),
                 i % 16 == 15 ? "\r\n" : "\t ");
        text += word;
    }
    return text;
}

// Any scale and number of values. The curve is sampled at 1024 irradiances, so the darkest greys differ most.
void test_read(void **) {
    for (int count : {256, 1024, 65536}) {
        const double gamma = 2.2;
        lensprof_response response;
        assert_ok(read_pcalib(gamma_text(gamma, count, 3.0, 1000.0), &response));
        assert_ok(lensprof_response_validate(&response));
        assert_int_equal(response.kind, LENSPROF_RESPONSE_TABLE);
        double worst = 0;
        for (int i = 0; i < count; i++) {
            const double b = i / (count - 1.0);
            worst = fmax(worst, fabs(lensprof_response_invert(&response, b, nullptr) - pow(b, gamma)));
        }
        assert_true(worst < 3e-4);  // a thirteenth of a level of 255, next to black
    }
}

// A curve that was read is written again: within a tenth of a level, next to black.
void test_round_trip(void **) {
    for (double gamma : {0.5, 1.0, 1.8, 2.2, 3.0}) {
        lensprof_response response;
        assert_ok(read_pcalib(gamma_text(gamma, 256, 0, 255), &response));
        const std::vector<double> again = numbers(write_pcalib(response));
        assert_int_equal(again.size(), 256);
        double worst = 0;
        for (int i = 0; i < 256; i++) worst = fmax(worst, fabs(again[i] - 255 * pow(i / 255.0, gamma)));
        assert_true(worst < (gamma == 1.0 ? 1e-12 : 0.1));
    }
}

// For every response, values increase even in the readers' single precision.
void test_increases(void **) {
    lensprof_response responses[4];
    const double step[5] = {0, 0, 1, 1, 1}, ends[4] = {0, 0.999, 0.999, 1};
    assert_ok(lensprof_response_set_table(&responses[0], step, 5));
    assert_ok(lensprof_response_set_table(&responses[1], ends, 4));
    assert_ok(lensprof_response_set_gamma(&responses[2], 10));
    assert_ok(lensprof_response_set_gamma(&responses[3], 0.1));
    for (const lensprof_response &response : responses) {
        const std::vector<double> values = numbers(write_pcalib(response));
        assert_int_equal(values.size(), 256);
        assert_true(values[0] == 0.0 && values[255] == 255.0);
        for (int i = 1; i < 256; i++) {
            assert_true(static_cast<float>(values[i]) > static_cast<float>(values[i - 1]));
            if (i < 255)  // 255 is saturated, whatever the irradiance
                assert_true(fabs(values[i] - 255 * lensprof_response_invert(&response, i / 255.0, nullptr)) <= 0.0256);
        }
        lensprof_response again;
        assert_ok(read_pcalib(write_pcalib(response), &again));
    }
}

void test_pcalib_refused(void **) {
    const struct {
        std::string text;
        lensprof_status status;
        const char *words;
    } cases[] = {
        {"", LENSPROF_ERROR_SYNTAX, "0 values"},
        {"7", LENSPROF_ERROR_SYNTAX, "1 values"},
        {gamma_text(2.2, 255, 0, 255), LENSPROF_ERROR_SYNTAX, "255 values, not 256 or more"},
        {"0 1\n2 nan 4", LENSPROF_ERROR_SYNTAX, "line 2: value 3 is \"nan\""},
        {"0 1 inf", LENSPROF_ERROR_SYNTAX, "value 2"},
        {"0 1 2,5", LENSPROF_ERROR_SYNTAX, "value 2"},
        {"0 1 2 2 3", LENSPROF_ERROR_RESPONSE, "value 3 (2) is not above the one before (2)"},
        {"0 1 2 1.5 3", LENSPROF_ERROR_RESPONSE, "value 3 (1.5)"},
        {std::string(3, '\0'), LENSPROF_ERROR_SYNTAX, "value 0"},
        {gamma_text(1, 65537, 0, 1), LENSPROF_ERROR_SIZE, "over 65536"},
    };
    for (const auto &c : cases) {
        lensprof_response response;
        response.kind = 99;
        std::string why;
        assert_int_equal(read_pcalib(c.text, &response, &why), c.status);
        if (why.find(c.words) == std::string::npos) fail_msg("\"%s\" instead of \"%s\"", why.c_str(), c.words);
        assert_int_equal(response.kind, 99);
    }
    lensprof_response bad;
    lensprof_response_set_linear(&bad);
    bad.table[7] = 2;
    assert_int_equal(lp_pcalib_write(&bad, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_RESPONSE);
    assert_int_equal(lp_pcalib_write(nullptr, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_pcalib_read(nullptr, 1, &bad, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_pcalib_read("0 1", 3, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_read),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_increases),
        cmocka_unit_test(test_pcalib_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
