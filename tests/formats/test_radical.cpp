// radical's .crf and .vgn files.
#include <algorithm>

#include "profile_support.hpp"

namespace {

// The header of a matrix, byte for byte: magic, type, dimensions, rows, columns.
std::string header(char type, char rows_low, char rows_high, char columns) {
    return std::string("\xD9\xFD\xA1\xC4", 4)
           + std::string({type, 0, 0, 0, 2, 0, 0, 0, rows_low, rows_high, 0, 0, columns, 0, 0, 0});
}

template <typename Number>
std::string bytes_of(const std::vector<Number> &values) {
    return std::string(reinterpret_cast<const char *>(values.data()), values.size() * sizeof(Number));
}

struct Responses {
    lensprof_response r[3];
};

lensprof_status read_responses(const std::string &data, Responses &responses, std::string *why = nullptr) {
    lensprof_error error;
    const std::vector<char> bytes = exact(data);
    const lensprof_status status = lp_radical_response_read(bytes.data(), bytes.size(), responses.r, &error);
    if (why) *why = error.text;
    return status;
}

std::string write_responses(const lensprof_response *responses, uint32_t count) {
    return written([&](void *data, size_t capacity, size_t *needed, lensprof_error *error) {
        return lp_radical_response_write(responses, count, data, capacity, needed, error);
    });
}

// Blue first, at any scale.
std::string golden_crf() {
    std::vector<float> values;
    for (int i = 0; i < 256; i++)
        for (float exponent : {3.0f, 2.0f, 1.0f}) values.push_back(5 * powf(float(i) / 255, exponent));
    return header(21, 0, 1, 1) + bytes_of(values);
}

void test_crf(void **) {
    auto responses = std::make_unique<Responses>(), again = std::make_unique<Responses>();
    assert_ok(read_responses(golden_crf(), *responses));
    for (int c = 0; c < 3; c++) {
        assert_ok(lensprof_response_validate(&responses->r[c]));
        assert_close(lensprof_response_invert(&responses->r[c], 0.5, nullptr), pow(0.5, c + 1), 1e-5);
    }
    const std::string data = write_responses(responses->r, 3);
    assert_int_equal(data.size(), 20 + 256 * 12);
    assert_memory_equal(data.data(), golden_crf().data(), 20);
    float blue_top;
    memcpy(&blue_top, data.data() + 20 + 255 * 12, 4);
    assert_true(blue_top == 1.0f);
    assert_ok(read_responses(data, *again));
    for (int c = 0; c < 3; c++)
        for (int j = 1; j < 1024; j++) assert_close(again->r[c].table[j], responses->r[c].table[j], 1e-3);
    assert_ok(read_responses(write_responses(responses->r, 1), *again));
    assert_memory_equal(again->r[0].table, again->r[2].table, sizeof again->r[0].table);
}

struct Found {
    lensprof_status status;
    std::string error;
    double worst;
    Profile profile;
};

Found read_vgn(const std::string &data) {
    Found found{};
    found.profile = full_profile();
    const Profile before = copy_of(*found.profile);
    lensprof_error error;
    const std::vector<char> bytes = exact(data);
    found.status = lp_radical_vignetting_read(bytes.data(), bytes.size(), found.profile.get(), &found.worst, &error);
    found.error = error.text;
    if (found.status != LENSPROF_OK)
        assert_memory_equal(found.profile.get(), before.get(), sizeof *before);
    else
        assert_ok(lensprof_profile_validate(found.profile.get()));
    return found;
}

std::string write_vgn(const lensprof_profile &profile, uint32_t width, uint32_t height) {
    return written([&](void *data, size_t capacity, size_t *needed, lensprof_error *error) {
        return lp_radical_vignetting_write(&profile, width, height, data, capacity, needed, error);
    });
}

const std::string kLine = "PolynomialVignettingModel 3 640 480\n";

// Centres (blue, green, red), then coefficients of r^2, r^4, r^6 in px; half the diagonal is 400 px.
std::vector<double> terms(double shift) {
    const double r2 = 1 / 160000.0, r4 = r2 * r2, r6 = r4 * r2;
    return {339.5 - shift, 339.5,    339.5 + shift, 219.5,    219.5,     219.5,     -0.4 * r2, -0.5 * r2,
            -0.6 * r2,     0.1 * r4, 0.2 * r4,      0.3 * r4, -0.1 * r6, -0.1 * r6, -0.1 * r6};
}

void test_polynomial(void **) {
    const Found found = read_vgn(kLine + header(22, 5, 0, 1) + bytes_of(terms(0)));
    assert_string_equal(found.error.c_str(), "");
    assert_true(found.worst == 0.0);
    const lensprof_profile &p = *found.profile;
    assert_int_equal(p.vignettings, 3);
    assert_int_equal(p.grid.columns, 0);
    assert_int_equal(p.covariance_size, 0);
    for (int c = 0; c < 3; c++) {
        assert_close(p.vignetting[c].k[0], -0.6 + 0.1 * c, 1e-12);
        assert_close(p.vignetting[c].k[1], 0.3 - 0.1 * c, 1e-12);
        assert_close(p.vignetting[c].center[0], 0.05, 1e-12);
        assert_close(p.vignetting[c].center[1], -0.05, 1e-12);
    }
    const std::string data = write_vgn(p, 640, 480);
    assert_int_equal(data.size(), kLine.size() + 20 + 15 * 8);
    assert_memory_equal(data.data(), (kLine + header(22, 5, 0, 1)).data(), kLine.size() + 20);
    std::vector<double> again(15);
    memcpy(again.data(), data.data() + kLine.size() + 20, 15 * 8);
    for (int i = 0; i < 15; i++) assert_close(again[i] / terms(0)[i], 1.0, 1e-12);
}

// A centre per channel, which a profile cannot hold: approximated by a refit with a grid, whose error is reported.
void test_centers(void **) {
    const Found found = read_vgn(kLine + header(22, 5, 0, 1) + bytes_of(terms(12)));
    assert_string_equal(found.error.c_str(), "");
    assert_true(found.worst > 0 && found.worst < 0.005);
    assert_true(found.profile->grid.columns > 0);
    const std::vector<double> t = terms(12);
    std::vector<float> values(64 * 48 * 3);
    assert_ok(lensprof_map_write(found.profile.get(), 640, 480, 64, 48, 3, 0, values.data(), nullptr));
    for (int i = 0; i < 64; i++)
        for (int c = 0; c < 3; c++) {
            const auto truth = [&](int column) {
                const double x = column * 10 + 4.5 - t[2 - c], y = 244.5 - t[5 - c], r2 = x * x + y * y;
                return 1 + r2 * (t[8 - c] + r2 * (t[11 - c] + r2 * t[14 - c]));
            };
            const auto at = [&](int column) { return double(values[(24 * 64 + column) * 3 + c]); };
            assert_close(at(i) / at(34) / (truth(i) / truth(34)), 1.0, 0.01);
        }
}

// A map, blue first. A profile with a grid is written as a map.
void test_map(void **) {
    std::vector<float> values;
    for (int j = 0; j < 48; j++)
        for (int i = 0; i < 64; i++)
            for (int c = 0; c < 3; c++) {
                const double x = (i - 31.5) / 40, y = (j - 23.5) / 40;
                values.push_back(float(1 - (0.3 + 0.1 * c) * (x * x + y * y)));
            }
    const std::string data = "NonparametricVignettingModel\n" + header(21, 48, 0, 64) + bytes_of(values);
    const Found found = read_vgn(data);
    assert_string_equal(found.error.c_str(), "");
    assert_true(found.worst < 1e-6);
    assert_close(found.profile->vignetting[0].k[0], -0.5, 1e-5);
    assert_close(found.profile->vignetting[2].k[0], -0.3, 1e-5);
    found.profile->grid.columns = found.profile->grid.rows = 2, found.profile->grid.channels = 1;
    for (int i = 0; i < 4; i++) found.profile->grid.attenuation[i] = 1;
    const std::string again = write_vgn(*found.profile, 64, 48);
    assert_int_equal(again.size(), data.size());
    assert_memory_equal(again.data(), data.data(), data.find('\n') + 21);
    std::vector<float> same(values.size());
    memcpy(same.data(), again.data() + again.find('\n') + 21, same.size() * 4);
    for (size_t i = 0; i < same.size(); i++)
        assert_close(double(same[i]) / double(same[0]), double(values[i]) / double(values[0]), 1e-5);
}

void test_refused(void **) {
    const std::string crf = golden_crf(), vgn = kLine + header(22, 5, 0, 1) + bytes_of(terms(0));
    auto responses = std::make_unique<Responses>();
    std::string why;
    const auto refused = [&](const std::string &data, lensprof_status status, const char *words) {
        responses->r[0].kind = 99;
        assert_int_equal(read_responses(data, *responses, &why), status);
        if (why.find(words) == std::string::npos) fail_msg("\"%s\" instead of \"%s\"", why.c_str(), words);
        assert_int_equal(responses->r[0].kind, 99);
    };
    refused("", LENSPROF_ERROR_SYNTAX, "truncated");
    refused(crf.substr(0, 19), LENSPROF_ERROR_SYNTAX, "truncated");
    refused(crf.substr(0, 1000), LENSPROF_ERROR_SYNTAX, "980 bytes");
    refused(crf + "x", LENSPROF_ERROR_SYNTAX, "3073 bytes");
    refused("PK" + crf, LENSPROF_ERROR_SYNTAX, "magic");
    refused(header(22, 0, 1, 1) + crf.substr(20), LENSPROF_ERROR_UNSUPPORTED, "type 22");
    refused(header(21, 0, 127, 127) + crf.substr(20), LENSPROF_ERROR_SYNTAX, "3072 bytes");
    refused(std::string(crf).replace(15, 1, "\x7f"), LENSPROF_ERROR_SIZE, "over 65536");
    refused(header(21, 2, 0, 1) + std::string(24, '\0'), LENSPROF_ERROR_SYNTAX, "of 2 grey values");
    refused(std::string(crf).replace(20 + 12 * 7, 4, "\0\0\xC0\x7f", 4), LENSPROF_ERROR_RESPONSE, "grey 7 of blue");
    refused(std::string(crf).replace(20 + 12 * 7 + 8, 4, 4, '\0'), LENSPROF_ERROR_RESPONSE, "grey 7 of red is darker");
    const auto not_read = [&](const std::string &data, lensprof_status status, const char *words) {
        const Found found = read_vgn(data);
        if (found.error.find(words) == std::string::npos)
            fail_msg("\"%s\" instead of \"%s\"", found.error.c_str(), words);
        assert_int_equal(found.status, status);
    };
    not_read("", LENSPROF_ERROR_SYNTAX, "no line of text");
    not_read(crf.substr(0, 3), LENSPROF_ERROR_SYNTAX, "no line of text");
    not_read("SomeModel\n", LENSPROF_ERROR_UNSUPPORTED, "\"SomeModel\"");
    not_read("PolynomialVignettingModel 3 640\n", LENSPROF_ERROR_SYNTAX, "degree, width and height are missing");
    not_read("PolynomialVignettingModel 3 640 99999999999\n", LENSPROF_ERROR_SYNTAX,
             "degree, width and height are missing");
    not_read("PolynomialVignettingModel 4 640 480\n", LENSPROF_ERROR_UNSUPPORTED, "degree 4");
    not_read("PolynomialVignettingModel 3 1 480\n" + vgn.substr(kLine.size()), LENSPROF_ERROR_SIZE, "1 x 480");
    not_read(vgn.substr(0, vgn.size() - 1), LENSPROF_ERROR_SYNTAX, "119 bytes");
    not_read(kLine + header(22, 4, 0, 1) + bytes_of(std::vector<double>(12)), LENSPROF_ERROR_SYNTAX, "without 5 rows");
    std::vector<double> t = terms(0);
    t[7] = NAN;
    not_read(kLine + header(22, 5, 0, 1) + bytes_of(t), LENSPROF_ERROR_NOT_FINITE, "not finite");
    t[7] = -1;
    not_read(kLine + header(22, 5, 0, 1) + bytes_of(t), LENSPROF_ERROR_VIGNETTING, "not above 0");
    const Profile p = full_profile();
    assert_int_equal(lp_radical_vignetting_write(p.get(), 1, 9, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_SIZE);
    assert_int_equal(lp_radical_vignetting_write(nullptr, 9, 9, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_radical_vignetting_read(nullptr, 9, p.get(), nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_radical_response_write(p->response, 2, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_radical_response_read(nullptr, 9, responses->r, nullptr), LENSPROF_ERROR_ARGUMENT);
    p->response[1].table[5] = 7;
    assert_int_equal(lp_radical_response_write(p->response, 3, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_RESPONSE);
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_crf), cmocka_unit_test(test_polynomial), cmocka_unit_test(test_centers),
        cmocka_unit_test(test_map), cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
