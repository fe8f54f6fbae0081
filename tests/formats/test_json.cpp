// Profiles as JSON: written profiles read back the same in every bit, and invalid ones are refused with the path of the
// fault.
#include <algorithm>

#include "profile_support.hpp"

namespace {

void assert_same(const lensprof_profile &a, const lensprof_profile &b) {
    assert_memory_equal(&a.key, &b.key, sizeof a.key);
    assert_memory_equal(&a.provenance, &b.provenance, sizeof a.provenance);
    assert_memory_equal(a.response, b.response, sizeof a.response[0] * a.responses);
    assert_memory_equal(a.vignetting, b.vignetting, sizeof a.vignetting[0] * a.vignettings);
    assert_memory_equal(&a.grid, &b.grid, sizeof a.grid);
    assert_memory_equal(a.covariance, b.covariance, sizeof a.covariance);
    assert_int_equal(a.responses, b.responses);
    assert_int_equal(a.vignettings, b.vignettings);
    assert_int_equal(a.covariance_size, b.covariance_size);
}

void test_round_trip(void **) {
    const Profile full = full_profile(), plain = new_profile();
    for (const lensprof_profile *profile : {full.get(), plain.get()}) {
        const Read read = read_json(write_json({profile}), nullptr);
        assert_string_equal(read.error.c_str(), "");
        assert_int_equal(read.profiles.size(), 1);
        assert_same(*read.profiles[0], *profile);
    }
    const std::string text = write_json({full.get(), plain.get(), full.get()});
    assert_int_equal(std::count(text.begin(), text.end(), '\n'), 4);
    const Read read = read_json(text, nullptr);
    assert_int_equal(read.profiles.size(), 3);
    for (size_t i = 0; i < 3; i++) assert_same(*read.profiles[i], i == 1 ? *plain : *full);
    assert_string_equal(write_json({}).c_str(), "{\"schema\":2,\"profiles\":[]}\n");
    assert_int_equal(read_json(write_json({})).profiles.size(), 0);
}

// Kinds are preserved, so that a curve can be evaluated by its formula.
void test_kinds(void **) {
    const Profile full = full_profile();
    const Read read = read_json(write_json({full.get()}));
    assert_int_equal(read.profiles[0]->response[0].kind, LENSPROF_RESPONSE_EMOR);
    assert_int_equal(read.profiles[0]->response[1].kind, LENSPROF_RESPONSE_GAMMA);
    assert_int_equal(read.profiles[0]->response[2].kind, LENSPROF_RESPONSE_TABLE);
    // Samples in single precision, as a blob holds them, read back unchanged.
    Profile rounded = new_profile();
    rounded->response[0] = full->response[0];
    for (double &value : rounded->response[0].table) value = static_cast<float>(value);
    assert_same(*read_json(write_json({rounded.get()}), nullptr).profiles[0], *rounded);
}

const std::string kShort =
    "{\"key\":{\"processing\":\"raw\",\"lens\":\"L\",\"distance_m\":null,\"later\":[{}]},\n"
    "\"vignetting\":{\"k\":[[-0.5,0,1e-3]]},\n"
    "\"response\":{\"kind\":\"emor\",\"emor\":[0.25]},\"more\":{\"a\":[1,[2]]}}";

void test_defaults(void **) {
    const Read read = read_json(kShort, "my.json");
    assert_string_equal(read.error.c_str(), "");
    const lensprof_profile &p = *read.profiles[0];
    assert_string_equal(p.key.lens, "L");
    assert_string_equal(p.provenance.source, "my.json");
    assert_true(p.key.focal_mm == LENSPROF_UNKNOWN && p.key.distance_m == LENSPROF_UNKNOWN);
    assert_int_equal(p.key.processing, LENSPROF_PROCESSING_RAW);
    assert_true(p.vignetting[0].k[2] == 1e-3 && p.vignetting[0].center[0] == 0.0);
    lensprof_response emor;
    const double term = 0.25;
    assert_ok(lensprof_response_set_emor(&emor, &term, 1));
    assert_memory_equal(p.response[0].table, emor.table, sizeof emor.table);
    assert_int_equal(p.grid.columns, 0);
    const Read unnamed = read_json(with(kShort, "\"more\"", "\"provenance\""), "a\nb");
    assert_string_equal(unnamed.profiles[0]->provenance.source, "a?b");
}

// Before "prior_id" and "forced" existed, the method ended with them.
void test_old_methods(void **) {
    const struct {
        const char *before, *method;
        int64_t prior;
        uint32_t forced;
    } cases[] = {{"transfer", "transfer", 0, 0},
                 {"transfer+12", "transfer", 12, 0},
                 {"transfer+12 (forced)", "transfer", 12, 1},
                 {"flat (forced)", "flat", 0, 1},
                 {"a+b", "a+b", 0, 0},
                 {"+5", "", 5, 0},
                 {"x+1+2", "x+1", 2, 0},
                 {"x+9223372036854775807", "x", INT64_MAX, 0},
                 {"x+9223372036854775808", "x", 0, 0},
                 {"12", "12", 0, 0},
                 {"", "", 0, 0}};
    for (const auto &c : cases) {
        const std::string old =
            with(kShort, "\"more\":{", std::string("\"provenance\":{\"method\":\"") + c.before + "\"},\"m\":{");
        const Read read = read_json(old);
        assert_string_equal(read.error.c_str(), "");
        const lensprof_provenance &p = read.profiles[0]->provenance;
        assert_string_equal(p.method, c.method);
        assert_int_equal(p.prior_id, c.prior);
        assert_int_equal(p.forced, c.forced);
    }
    // If a file has one of these members, the method is not parsed.
    const Read read = read_json(
        with(kShort, "\"more\":{", "\"provenance\":{\"method\":\"transfer+12 (forced)\",\"prior_id\":null},\"m\":{"));
    assert_string_equal(read.profiles[0]->provenance.method, "transfer+12 (forced)");
    assert_int_equal(read.profiles[0]->provenance.prior_id, 0);
}

void test_refused(void **) {
    const Profile full = full_profile();
    const std::string list = write_json({full.get(), full.get()}), one = write_json({full.get()});
    const struct {
        std::string text;
        lensprof_status status;
        const char *words;
    } cases[] = {
        {"", LENSPROF_ERROR_SYNTAX, "line 1: not JSON"},
        {"[]", LENSPROF_ERROR_SYNTAX, "is not an object"},
        {"{}", LENSPROF_ERROR_SYNTAX, "has no \"key\""},
        {one.substr(0, one.size() / 2), LENSPROF_ERROR_SYNTAX, "line 1: not JSON"},
        {with(kShort, "1e-3", "1e999"), LENSPROF_ERROR_SYNTAX, "line 2: \"1e999\" is out of range"},
        {with(kShort, "1e-3", "NaN"), LENSPROF_ERROR_SYNTAX, "line 2: not JSON"},
        {with(kShort, "1e-3", "null"), LENSPROF_ERROR_SYNTAX, "vignetting.k[0][2] is not a number"},
        {with(kShort, "1e-3", "1,2"), LENSPROF_ERROR_SYNTAX, "vignetting.k[0] has 4 items"},
        {with(kShort, "-0.5", "-1.5"), LENSPROF_ERROR_VIGNETTING, "vignetting.k[0] is not a valid falloff"},
        {with(kShort, "[[-0.5,0,1e-3]]", "[]"), LENSPROF_ERROR_SYNTAX, "vignetting.k does not have one or three"},
        {with(kShort, "\"L\"", "\"\xff\""), LENSPROF_ERROR_SYNTAX, "line 1: not UTF-8"},
        {with(kShort, "\"L\"", "\"\\u0007\""), LENSPROF_ERROR_SYNTAX, "key.lens has control characters"},
        {with(kShort, "\"L\"", "\"" + std::string(128, 'x') + "\""), LENSPROF_ERROR_SYNTAX,
         "key.lens is longer than 127"},
        {with(kShort, "\"L\"", "7"), LENSPROF_ERROR_SYNTAX, "key.lens is not a text"},
        {with(kShort, "\"raw\"", "\"tiff\""), LENSPROF_ERROR_SYNTAX, "key.processing is \"tiff\""},
        {with(kShort, "\"processing\":\"raw\",", ""), LENSPROF_ERROR_SYNTAX, "key has no \"processing\""},
        {with(kShort, "\"distance_m\":null", "\"distance_m\":-1"), LENSPROF_ERROR_SYNTAX,
         "key.distance_m is not above 0"},
        {with(kShort, "0.25", "250"), LENSPROF_ERROR_RESPONSE, "response.emor is not a response"},
        {with(kShort, "\"emor\",", "\"table\","), LENSPROF_ERROR_SYNTAX, "response has no \"values\""},
        {with(kShort, "\"emor\",", "\"gamma\","), LENSPROF_ERROR_SYNTAX, "response has no \"gamma\""},
        {with(kShort, "{\"key\"", "{\"schema\":3,\"key\""), LENSPROF_ERROR_UNSUPPORTED,
         "schema is above 2; use a newer lensprof"},
        {with(one, "\"image_circle\":{\"center\":[", "\"image_circle\":{\"center\":[-3,"), LENSPROF_ERROR_SYNTAX,
         "image_circle.center has 3 items"},
        {with(one, "\"image_circle\":{\"center\":[0", "\"image_circle\":{\"center\":[-3"), LENSPROF_ERROR_ARGUMENT,
         "image_circle is not a valid image circle"},
        {with(one, "\"radius\":0", "\"radius\":-0"), LENSPROF_ERROR_SYNTAX, "image_circle.radius is -0"},
        {with(one, "\"radius\":", "\"radius\":0,\"r\":"), LENSPROF_ERROR_SYNTAX, "image_circle.radius is 0"},
        {with(one, "\"radius\":", "\"r\":"), LENSPROF_ERROR_SYNTAX, "image_circle has no \"radius\""},
        {with(one, "\"columns\":3", "\"columns\":4"), LENSPROF_ERROR_SYNTAX, "gain_grid.attenuation[0][0] has 3 items"},
        {with(one, "\"columns\":3", "\"columns\":4000000000"), LENSPROF_ERROR_SYNTAX,
         "gain_grid.columns is 4000000000"},
        {with(one, "\"covariance\":[[", "\"covariance\":[[1,"), LENSPROF_ERROR_SYNTAX, "covariance[0] has 6 items"},
        {with(one, "\"covariance\":[[", "\"covariance\":[[-"), LENSPROF_ERROR_ARGUMENT, "is not a valid profile"},
        {with(one, "\"images\":4000000000", "\"images\":5000000000"), LENSPROF_ERROR_SYNTAX,
         "provenance.images is 5000000000"},
        {with(one, "\"forced\":true", "\"forced\":1"), LENSPROF_ERROR_SYNTAX, "provenance.forced is not true or false"},
        {with(one, "\"prior_id\":12", "\"prior_id\":0"), LENSPROF_ERROR_SYNTAX, "provenance.prior_id is 0"},
        {with(one, "\"prior_id\":12", "\"prior_id\":\"12\""), LENSPROF_ERROR_SYNTAX,
         "provenance.prior_id is not an integer"},
        {with(one, "\"gamma_sigma\":0.0", "\"gamma_sigma\":-0.0"), LENSPROF_ERROR_SYNTAX, "provenance.gamma_sigma is "},
        {with(one, "\"style\":\"PROVIA", "\"style\":7,\"a\":\"PROVIA"), LENSPROF_ERROR_SYNTAX,
         "key.style is not a text"},
        {with(one, "\"color_temperature_k\":4321.5", "\"color_temperature_k\":-1"), LENSPROF_ERROR_SYNTAX,
         "key.color_temperature_k is not above 0"},
        {with(one, "\"values\":[[0.0,", "\"values\":[[0.5,"), LENSPROF_ERROR_SYNTAX,
         "response.values[0] does not match the curve"},
        {with(list, "\"profiles\":[", "\"profiles\":[null,"), LENSPROF_ERROR_SYNTAX, "profiles holds null"},
        {with(list, "\"k\":[[", "\"k\":[[1e7,"), LENSPROF_ERROR_SYNTAX, "profiles[0].vignetting.k[0] has 4 items"},
        {"{\"a\":" + std::string(100000, '[') + "]}", LENSPROF_ERROR_SYNTAX, "over 32 levels"},
        {"{\"a\":[0" +
             [] {
                 std::string s;
                 for (int i = 0; i < 4000000; i++) s += ",0";
                 return s;
             }()
             + "]}",
         LENSPROF_ERROR_SIZE, "4 million"},
        {std::string((64u << 20) + 1, ' '), LENSPROF_ERROR_SIZE, "64 MiB"},
    };
    for (const auto &c : cases) {
        const Read read = read_json(c.text);
        if (read.error.find(c.words) == std::string::npos)
            fail_msg("\"%s\" instead of \"%s\"", read.error.c_str(), c.words);
        assert_int_equal(read.status, c.status);
        assert_int_equal(read.profiles.size(), 0);
    }
}

lensprof_status stop(void *, const lensprof_import_entry *) { return LENSPROF_ERROR_CANCELLED; }

void test_calls(void **) {
    lensprof_error error;
    const std::string text = write_json({full_profile().get()});
    assert_int_equal(lp_json_read(text.data(), text.size(), nullptr, stop, nullptr, &error), LENSPROF_ERROR_CANCELLED);
    assert_int_equal(lp_json_read(nullptr, 1, nullptr, stop, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_json_read("{}", 2, nullptr, nullptr, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_json_write(nullptr, 1, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    Profile bad = new_profile();
    bad->vignetting[0].k[0] = -5;
    const lensprof_profile *const one = bad.get();
    assert_int_equal(lp_json_write(&one, 1, nullptr, 0, nullptr, &error), LENSPROF_ERROR_VIGNETTING);
    assert_non_null(strstr(error.text, "profile 0: is invalid"));
    // Texts of a database need not be UTF-8, but JSON must be.
    Profile latin = new_profile();
    strcpy(latin->key.lens, "\xe9t\xe9");
    assert_string_equal(read_json(write_json({latin.get()})).profiles[0]->key.lens, "\xef\xbf\xbdt\xef\xbf\xbd");
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),  cmocka_unit_test(test_kinds),   cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_old_methods), cmocka_unit_test(test_refused), cmocka_unit_test(test_calls),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
