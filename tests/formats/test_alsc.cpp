// Lens shading tables of the Raspberry Pi.
#include <algorithm>

#include "profile_support.hpp"

namespace {

constexpr uint32_t kWidth = 3280, kHeight = 2464;

struct Found {
    lensprof_status status;
    std::string error;
    double worst;
    Profile profile;
};

Found read(const std::string &text, double ct = LENSPROF_UNKNOWN, uint32_t columns = 0, uint32_t rows = 0) {
    Found found{};
    found.profile = full_profile();
    const Profile before = copy_of(*found.profile);
    lensprof_error error;
    const std::vector<char> bytes = exact(text);
    found.status = lp_alsc_read(bytes.data(), bytes.size(), ct, columns, rows, kWidth, kHeight, found.profile.get(),
                                &found.worst, &error);
    found.error = error.text;
    if (found.status != LENSPROF_OK)
        assert_memory_equal(found.profile.get(), before.get(), sizeof *before);
    else
        assert_ok(lensprof_profile_validate(found.profile.get()));
    return found;
}

std::string write(const lensprof_profile &profile, double ct = 5000, uint32_t columns = 16, uint32_t rows = 12) {
    return written([&](void *text, size_t capacity, size_t *needed, lensprof_error *error) {
        return lp_alsc_write(&profile, ct, columns, rows, kWidth, kHeight, text, capacity, needed, error);
    });
}

Profile lens() {
    Profile profile = new_profile();
    profile->vignettings = 3;
    for (int c = 0; c < 3; c++) profile->vignetting[c] = {{-0.55 + 0.05 * c, 0.1, 0}, {0.03, -0.02}};
    return profile;
}

// M of a channel relative to the middle, at a fraction `way` of the distance from the middle to the first corner.
double shade(const lensprof_profile &profile, uint32_t channel, double way) {
    std::vector<float> values(201 * 151 * 3);
    assert_ok(lensprof_map_write(&profile, kWidth, kHeight, 201, 151, 3, 0, values.data(), nullptr));
    const auto at = [&](int x, int y) { return double(values[(size_t(y) * 201 + x) * 3 + channel]); };
    return at(int(100 - 100 * way), int(75 - 75 * way)) / at(100, 75);
}

// 3 decimals: within a thousandth at a gain of 1. The tables end at the middles of the outermost cells.
void test_round_trip(void **) {
    const Profile truth = lens();
    for (const uint32_t columns : {16u, 32u, 20u}) {
        const uint32_t rows = columns == 16 ? 12 : columns == 32 ? 32 : 10;
        const Found found =
            read(write(*truth, 5000, columns, rows), LENSPROF_UNKNOWN, columns == 20 ? 20 : 0, columns == 20 ? 10 : 0);
        assert_string_equal(found.error.c_str(), "");
        assert_true(found.worst < 2e-3);
        assert_int_equal(found.profile->vignettings, 3);
        assert_int_equal(found.profile->covariance_size, 0);
        for (uint32_t c = 0; c < 3; c++)
            for (const double way : {0.3, 0.6, 0.9})
                assert_close(shade(*found.profile, c, way), shade(*truth, c, way), 2e-3);
    }
}

std::string table(double first, double others, size_t count = 192) {
    std::string text = "[" + std::to_string(first);
    for (size_t i = 1; i < count; i++) text += "," + std::to_string(others);
    return text + "]";
}

// A tuning file with a green channel that is darker in the corner, and red and blue by their ratios.
std::string tuning_file() {
    const std::string text = write(*lens());
    return "{\"version\":2.0,\"target\":\"bcm2835\",\"algorithms\":[{\"rpi.dpc\":{}}," + text + "]}";
}

// Cr is a factor of red's gain: if it is large, red is dark compared with green.
void test_sense(void **) {
    const std::string text = write(*lens());
    assert_int_equal(
        text.find(
            "{\"rpi.alsc\":{\n\"omega\":1.3,\"n_iter\":100,\"luminance_strength\":1.0,\n\"calibrations_Cr\":[{\"ct\":5000,\"table\":[\n1."),
        0);
    assert_true(text.find("corner_strength") == std::string::npos);  // a corner_strength would replace the table
    const double red = std::stod(text.substr(text.find("table\":[") + 8)),
                 luminance = std::stod(text.substr(text.find("luminance_lut\":[") + 16));
    assert_close(luminance, 1 / shade(*lens(), 1, 0.94), 0.05);
    assert_true(red > 1.02 && red < 1.2);  // red has the strongest falloff
    const Found found = read(tuning_file());
    assert_string_equal(found.error.c_str(), "");
    assert_close(shade(*found.profile, 0, 0.9), shade(*lens(), 0, 0.9), 2e-3);
}

std::string with_two(double low, double high) {
    return "{\"luminance_lut\":" + table(1, 1) + ",\"default_ct\":4000,\"calibrations_Cr\":[{\"ct\":3000,\"table\":"
           + table(low, 1) + "},{\"ct\":5000,\"table\":" + table(high, 1) + "}]}";
}

// Linear between two tables, the nearest table beyond them, and default_ct without a temperature.
void test_temperature(void **) {
    const auto corner = [&](double ct) {
        const Found found = read(with_two(1.2, 1.6), ct);
        assert_string_equal(found.error.c_str(), "");
        assert_int_equal(found.profile->vignettings, 3);
        return found.profile->grid.attenuation[0]
               * lensprof_vignetting_eval(&found.profile->vignetting[0], 1.0, nullptr);
    };
    const double low = corner(3000), high = corner(5000);
    assert_true(low > high + 0.03);
    assert_true(corner(1000) == low && corner(9000) == high);
    const double middle = corner(4000);
    assert_true(middle < low && middle > high);
    assert_true(corner(LENSPROF_UNKNOWN) == middle);
    assert_true(corner(3500) > middle && corner(3500) < low);
    const Found grey = read("{\"luminance_lut\":" + table(1, 1) + "}");
    assert_int_equal(grey.profile->vignettings, 1);
    // The key has the temperature if the tables depend on it, and the writer takes it from there.
    assert_true(grey.profile->key.color_temperature_k == LENSPROF_UNKNOWN);
    const Found own = read(with_two(1.2, 1.6));
    assert_true(own.profile->key.color_temperature_k == 4000.0);
    assert_true(read(with_two(1.2, 1.6), 3500).profile->key.color_temperature_k == 3500.0);
    assert_true(write(*own.profile, LENSPROF_UNKNOWN).find("\"ct\":4000") != std::string::npos);
    assert_true(write(*own.profile, 2800).find("\"ct\":2800") != std::string::npos);
    assert_true(write(*grey.profile, LENSPROF_UNKNOWN).find("\"ct\":4500") != std::string::npos);
}

// As libcamera: a comma before a bracket, both versions of tuning files, and files without a table.
void test_tuning_files(void **) {
    const std::string plain = tuning_file(), object = write(*lens());
    const Found expected = read(plain);
    std::string commas;
    bool is_quoted = false;
    for (const char c : plain) {
        is_quoted ^= c == '"';
        if (!is_quoted && (c == ']' || c == '}') && commas.back() != '[' && commas.back() != '{') commas += ", \n";
        commas += c;
    }
    const std::string version1 = "{\"rpi.black_level\":{\"black_level\":4096}," + object.substr(1);
    for (const std::string &text : {commas, version1, with(commas, "1.0", "1.0 "), "\xEF\xBB\xBF" + commas}) {
        const Found found = read(text);
        assert_string_equal(found.error.c_str(), "");
        for (uint32_t c = 0; c < 3; c++)
            assert_close(shade(*found.profile, c, 0.9), shade(*expected.profile, c, 0.9), 1e-9);
    }
    for (const char *wrong : {"{\"luminance_lut\":[,]}", "{,}", "{\"luminance_lut\":[1,1,1,,]}", "{\"a\":,}",
                              "{\"luminance_lut\":[1,1,1,1],},", "{\"a\":\",]\",\"luminance_lut\":[1,2}"}) {
        if (read(wrong).status != LENSPROF_ERROR_SYNTAX) fail_msg("%s is accepted", wrong);
    }
    const char *const without[] = {"{\"version\":2.0,\"algorithms\":[{\"rpi.awb\":{}},]}",
                                   "{\"version\":2.0,\"algorithms\":[{\"rpi.alsc\":{\"omega\":1.3,}}]}",
                                   "{\"rpi.black_level\":{},\"rpi.awb\":{}}",
                                   "{\"rpi.alsc\":{\"n_iter\":0,\"corner_strength\":1.5}}"};
    for (const char *text : without) {
        const Found found = read(text);
        assert_int_equal(found.status, LENSPROF_ERROR_NOT_FOUND);
        assert_non_null(strstr(found.error.c_str(), "no table of lens shading"));
    }
    // A comma in a text is not one of the JSON.
    assert_string_equal(read("{\"a\":\",]\\\",}\"," + object.substr(1)).error.c_str(), "");
}

void test_refused(void **) {
    const std::string good = with_two(1.2, 1.6);
    const struct {
        std::string text;
        lensprof_status status;
        const char *words;
    } cases[] = {
        {"", LENSPROF_ERROR_SYNTAX, "line 1: not JSON"},
        {"[]", LENSPROF_ERROR_SYNTAX, "is not an object"},
        {"{}", LENSPROF_ERROR_SYNTAX, "has no \"luminance_lut\""},
        {"{\"algorithms\":[{\"rpi.dpc\":{}}]}", LENSPROF_ERROR_NOT_FOUND, "algorithms has no \"rpi.alsc\""},
        {"{\"algorithms\":7}", LENSPROF_ERROR_SYNTAX, "algorithms is not an array"},
        {"{\"rpi.alsc\":[]}", LENSPROF_ERROR_SYNTAX, "rpi.alsc is not an object"},
        {"{\"corner_strength\":2.0," + good.substr(1), LENSPROF_ERROR_UNSUPPORTED, "corner_strength makes"},
        {with(good, "[1.000000,", "["), LENSPROF_ERROR_SYNTAX, "luminance_lut has 191 values, not 16 x 12"},
        {with(good, "[1.2", "[1,1.2"), LENSPROF_ERROR_SYNTAX, "calibrations_Cr[0].table has 193 values"},
        {with(good, "[1.200000", "[0"), LENSPROF_ERROR_VIGNETTING, "calibrations_Cr[0].table has 0 at 0"},
        {with(good, "[1.200000", "[-1"), LENSPROF_ERROR_VIGNETTING, "not a gain"},
        {with(good, "[1.200000", "[1e9"), LENSPROF_ERROR_VIGNETTING, "not a gain"},
        {with(good, "[1.200000", "[null"), LENSPROF_ERROR_SYNTAX, "calibrations_Cr[0].table[0] is not a number"},
        {with(good, "\"ct\":5000", "\"ct\":3000"), LENSPROF_ERROR_SYNTAX,
         "calibrations_Cr[1] does not have a higher ct"},
        {with(good, "\"ct\":5000,", ""), LENSPROF_ERROR_SYNTAX, "calibrations_Cr[1] has no \"ct\""},
        {good.substr(0, good.size() / 2), LENSPROF_ERROR_SYNTAX, "not JSON"},
        {with(good, "[1.2", "[\xff"), LENSPROF_ERROR_SYNTAX, "not UTF-8"},
    };
    for (const auto &c : cases) {
        const Found found = read(c.text);
        if (found.error.find(c.words) == std::string::npos)
            fail_msg("\"%s\" instead of \"%s\"", found.error.c_str(), c.words);
        assert_int_equal(found.status, c.status);
    }
    assert_non_null(strstr(read(good, 4000, 10, 10).error.c_str(), "192 values, not 10 x 10"));
    assert_int_equal(read(good, 0).status, LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(read(good, NAN).status, LENSPROF_ERROR_ARGUMENT);
    const Profile p = lens();
    const auto status = [&](double ct, uint32_t columns, uint32_t width) {
        return lp_alsc_write(p.get(), ct, columns, 12, width, 10, nullptr, 0, nullptr, nullptr);
    };
    assert_int_equal(status(5000, 1, 10), LENSPROF_ERROR_SIZE);
    assert_int_equal(status(5000, 257, 10), LENSPROF_ERROR_SIZE);
    assert_int_equal(status(5000, 16, 0), LENSPROF_ERROR_SIZE);
    assert_int_equal(status(0, 16, 10), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(status(5000, 16, 10), LENSPROF_OK);
    p->vignetting[1].k[0] = -9;
    assert_int_equal(status(5000, 16, 10), LENSPROF_ERROR_VIGNETTING);
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),   cmocka_unit_test(test_sense),   cmocka_unit_test(test_temperature),
        cmocka_unit_test(test_tuning_files), cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
