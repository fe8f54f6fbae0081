// Response curves as CSV and as matrices of pfstools.
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
    curves->status = lp_curves_read(bytes.data(), bytes.size(), curve, curves->response, &curves->count, &error);
    curves->error = error.text;
    assert_true((curves->status == LENSPROF_OK) == curves->error.empty());
    assert_true(curves->status == LENSPROF_OK || curves->count == 99);
    return curves;
}

std::string write(const lensprof_response *responses, uint32_t count, uint32_t curve, uint32_t rows) {
    return written([&](void *text, size_t capacity, size_t *needed, lensprof_error *error) {
        return lp_curves_write(responses, count, curve, rows, text, capacity, needed, error);
    });
}

double at(const Curves &curves, int channel, double x) {
    return lensprof_response_eval(&curves.response[channel], x, nullptr);
}

void test_layouts(void **) {
    // From OpenCV, AliceVision, a spreadsheet, and pasted text.
    for (const char *text :
         {"0.5, 1, 2\n1, 2, 4\n2, 4, 8\n4, 8, 16\n", "0.5;1;2\n1;2;4\n2;4;8\n4;8;16",
          "response,Red,Green,Blue,\n0,0.5,1,2,\n1,1,2,4,\n2,2,4,8,\n3,4,8,16,\n",
          "# made by hand\n\nx\tR\tG\tB\r\n0\t.5\t1\t2\r\n10\t1\t2\t4\r\n20\t2\t4\t8\r\n30\t4\t8\t16\r\n",
          "% bgr\nBlue green Red\n2 1 0.5\n4 2 1\n8 4 2\n16 8 4\n",
          "[0.5, 1, 2;\n 1, 2, 4;\n 2, 4, 8;\n 4, 8, 16]\n"}) {
        const auto curves = read(text);
        assert_string_equal(curves->error.c_str(), "");
        assert_int_equal(curves->count, 3);
        for (int c = 0; c < 3; c++) {
            assert_ok(lensprof_response_validate(&curves->response[c]));
            assert_close(at(*curves, c, 0.25), 1.0 / 3, 1e-3);
            assert_close(at(*curves, c, 0.5), 2.0 / 3, 1e-3);
            assert_close(at(*curves, c, 0.1), 0.0, 0.0);  // darker than the first row
        }
    }
    for (const char *text : {"0\n1\n4\n", "0 0\n1 1\n2 4\n", "0,0\n0.5,1\n1,4"}) assert_int_equal(read(text)->count, 1);
}

void test_channels(void **) {
    const auto rgb = read("0,0,0\n1,2,3\n4,4,4\n"), bgr = read("b,g,r\n0,0,0\n3,2,1\n4,4,4\n");
    for (int c = 0; c < 3; c++) {
        assert_close(at(*rgb, c, (c + 1) / 4.0), 0.5, 1e-3);
        assert_close(at(*bgr, c, (c + 1) / 4.0), 0.5, 1e-3);
    }
}

void test_kinds(void **) {
    const auto log = read("-2\n-1\n1\n", LENSPROF_CURVE_LOG), ten = read("-2\n-1\n1\n", LENSPROF_CURVE_LOG10);
    assert_close(at(*log, 0, exp(-2.0)), 0.5, 2e-3);
    assert_close(at(*ten, 0, 0.01), 0.5, 1e-2);
    const auto forward = read("16\n116\n216\n", LENSPROF_CURVE_FORWARD);
    assert_close(at(*forward, 0, 0.25), 0.25, 1e-12);
}

const char kPfs[] =
    "# Camera response curve, channel IR\n# data layout: log10(response) | camera output | response\n"
    "# name: IR\n# type: matrix\n# rows: 3\n# columns: 3\n -6.000000e+00    0 0.000000e+00\n"
    " 0.000000e+00    1 1.000000e+00\n 6.0e-01    2 4.000000e+00\n\n"
    "# name: IG\n -6 0 0\n 0 1 2\n 0.6 2 4\n\n# name: IB\n -6 0 0\n 0 1 3\n 0.6 2 4\n";

void test_pfstools(void **) {
    const auto curves = read(kPfs, LENSPROF_CURVE_LOG);
    assert_string_equal(curves->error.c_str(), "");
    assert_int_equal(curves->count, 3);
    for (int c = 0; c < 3; c++) assert_close(at(*curves, c, (c + 1) / 4.0), 0.5, 1e-3);
}

// Write, then read: within a thirteenth of a level of 255.
void test_round_trip(void **) {
    const auto profile = new_profile();
    lensprof_response *responses = profile->response;
    const double emor[2] = {0.3, -0.1};
    assert_ok(lensprof_response_set_emor(&responses[0], emor, 2));
    assert_ok(lensprof_response_set_gamma(&responses[1], 2.2));
    for (uint32_t curve = 0; curve <= LENSPROF_CURVE_FORWARD; curve++)
        for (uint32_t count : {1u, 3u})
            for (uint32_t rows : {256u, 4096u}) {
                const auto again = read(write(responses, count, curve, rows), curve);
                assert_string_equal(again->error.c_str(), "");
                assert_int_equal(again->count, count);
                double worst = 0;
                for (uint32_t c = 0; c < count; c++)
                    for (int i = 1; i <= 1000; i++) {
                        const double x = i / 1000.0;
                        worst = fmax(worst, fabs(lensprof_response_eval(&again->response[c], x, nullptr)
                                                 - lensprof_response_eval(&responses[c], x, nullptr)));
                    }
                // A forward table is coarse at steep parts of the response.
                const bool coarse = curve == LENSPROF_CURVE_FORWARD && rows == 256;
                assert_true(worst < (coarse ? (count == 3 ? 0.025 : 3e-3) : 3e-4));
            }
    const std::string text = write(responses, 3, LENSPROF_CURVE_INVERSE, 256);
    assert_int_equal(text.find("grey,red,green,blue\n0,0,0,0\n1,"), 0);
    assert_true(write(responses, 1, LENSPROF_CURVE_LOG, 2) == "grey,ln(irradiance)\n0,-13.815510557964274\n1,0\n");
    assert_true(write(responses + 2, 1, LENSPROF_CURVE_FORWARD, 3) == "irradiance,grey\n0,0\n0.5,0.5\n1,1\n");
}

void test_refused(void **) {
    const std::string pfs = kPfs;
    const struct {
        std::string text;
        lensprof_status status;
        const char *words;
        uint32_t curve;
    } cases[] = {
        {"", LENSPROF_ERROR_SYNTAX, "no row of numbers", 0},
        {"a,b\n", LENSPROF_ERROR_SYNTAX, "no row of numbers", 0},
        {"a,b\nc,d\n", LENSPROF_ERROR_SYNTAX, "line 2: \"c\" is not a finite number", 0},
        {"1\n", LENSPROF_ERROR_SYNTAX, "line 1: only one row", 0},
        {"1\n2\nx\n", LENSPROF_ERROR_SYNTAX, "line 3: \"x\"", 0},
        {"1\nnan\n", LENSPROF_ERROR_SYNTAX, "line 2: \"nan\"", 0},
        {"1\n1e999\n", LENSPROF_ERROR_SYNTAX, "line 2", 0},
        {"1\n2 3\n", LENSPROF_ERROR_SYNTAX, "line 2: 2 columns", 0},
        {"1 2 3 4 5\n1 2 3 4 5\n", LENSPROF_ERROR_SYNTAX, "line 1: 5 columns", 0},
        {"1\n3\n2\n", LENSPROF_ERROR_RESPONSE, "line 3: 2 is below the 3 before it", 0},
        {"-1\n3\n", LENSPROF_ERROR_RESPONSE, "check whether the table is logarithmic", 0},
        {"0\n0\n", LENSPROF_ERROR_RESPONSE, "line 2: the last value", 0},
        {"3\n3\n", LENSPROF_ERROR_RESPONSE, "line 2: the last value", LENSPROF_CURVE_LOG},
        {"1 1\n2 2\n", LENSPROF_ERROR_SYNTAX, "line 1: column 1", 0},
        {"0 1\n1 2\n3 4\n4 5\n", LENSPROF_ERROR_SYNTAX, "line 2: column 1", 0},
        {"0 1\n0 2\n", LENSPROF_ERROR_SYNTAX, "column 1", 0},
        {"0\n\xff\xfe\n", LENSPROF_ERROR_SYNTAX, "line 2", 0},
        {"0\n" + std::string(2, '\0') + "\n", LENSPROF_ERROR_SYNTAX, "line 2", 0},
        {pfs.substr(0, pfs.find("# name: IB")), LENSPROF_ERROR_SYNTAX, "2 matrices", 0},
        {with(pfs, " 0 1 2\n", " 0 1 5\n"), LENSPROF_ERROR_RESPONSE, "line 14: 4 is below the 5", 0},
        {with(pfs, " -6 0 0\n 0 1 2\n 0.6 2 4\n", "1 2\n3 4\n"), LENSPROF_ERROR_SYNTAX, "a matrix without 3 columns",
         0},
        {[] {
             std::string s;
             for (int i = 0; i < 65537; i++) s += "1\n";
             return s;
         }(),
         LENSPROF_ERROR_SIZE, "line 65537", 0},
        {std::string((64u << 20) + 1, '\n'), LENSPROF_ERROR_SIZE, "64 MiB", 0},
    };
    for (const auto &c : cases) {
        const auto curves = read(c.text, c.curve);
        if (curves->error.find(c.words) == std::string::npos)
            fail_msg("\"%s\" instead of \"%s\"", curves->error.c_str(), c.words);
        assert_int_equal(curves->status, c.status);
    }
    const auto profile = new_profile();
    lensprof_response *r = profile->response;
    uint32_t count;
    assert_int_equal(lp_curves_read("1\n2", 3, 4, r, &count, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_curves_read("1\n2", 3, 0, r, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_curves_write(r, 2, 0, 256, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_curves_write(r, 1, 0, 1, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_curves_write(r, 1, 4, 256, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    r[2].table[3] = NAN;
    assert_int_equal(lp_curves_write(r, 3, 0, 256, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_RESPONSE);
}

// 256 greys of x^gamma, of some range, with a dip of so many levels in front of each of the given greys.
std::vector<double> with_dips(double gamma, double range, double dip, std::initializer_list<int> greys) {
    std::vector<double> values;
    for (int i = 0; i < 256; i++) values.push_back(range * pow(i / 255.0, gamma));
    for (const int grey : greys) values[grey] = values[grey - 1] - range / 255 * dip;
    return values;
}

std::string rows(const std::vector<double> &values, const char *end) {
    std::string text;
    char word[40];
    for (const double value : values) snprintf(word, sizeof word, "%.12g%s", value, end), text += word;
    return text;
}

// What lensprof_import makes of a table.
struct Repaired {
    lensprof_status status;
    double change = -1;
    Profile profile;
};

Repaired import_table(const std::string &text, uint32_t format, uint32_t strict = 0, uint32_t curve = 0) {
    lensprof_import_options options;
    lensprof_import_options_init(&options);
    options.format = format, options.strict = strict, options.curve = curve;
    Repaired found;
    const auto keep = [](void *user, const lensprof_import_entry *entry) {
        auto &into = *static_cast<Repaired *>(user);
        into.change = entry->change, into.profile = copy_of(*entry->profile);
        return LENSPROF_OK;
    };
    const std::vector<char> bytes = exact(text);
    found.status = lensprof_import(bytes.data(), bytes.size(), &options, keep, &found, nullptr);
    return found;
}

// Responses that decrease in places are read as the nearest increasing curve, which is never farther from the truth
// than the dips are; by more than a level they are doubtful, and `strict` refuses them.
void test_dips(void **) {
    for (const double gamma : {0.6, 1.0, 1.9, 2.4})
        for (const double range : {255.0, 1.0, 40000.0})
            for (const double dip : {0.0, 0.3, 0.9, 4.0}) {
                const std::vector<double> values = with_dips(gamma, range, dip, {28, 120, 121, 200});
                for (const uint32_t format : {LENSPROF_FORMAT_PCALIB, LENSPROF_FORMAT_CURVES}) {
                    const std::string text = rows(values, format == LENSPROF_FORMAT_PCALIB ? " " : "\n");
                    const Repaired found = import_table(text, format);
                    const double change = found.change;
                    assert_ok(found.status);
                    const lensprof_response &response = found.profile->response[0];
                    double off = 0, least = 0;
                    for (int i = 0; i < 256; i++)
                        off = fmax(off,
                                   fabs(lensprof_response_invert(&response, i / 255.0, nullptr) - values[i] / range));
                    for (int i = 1; i < 256; i++) least = fmax(least, (values[i - 1] - values[i]) / range * 255 / 2);
                    assert_true(change >= least - 1e-6);  // half a fall is the least that removes it
                    assert_true(change <= 3 * (dip + 2.5));
                    assert_true(off * 255 <= change + 0.6);  // of samples that hold the curve
                    assert_int_equal(*found.profile->provenance.doubt != 0, change > 1.0);
                    if (dip > 0.0) assert_int_equal(import_table(text, format, 1).status, LENSPROF_ERROR_RESPONSE);
                }
            }
    const std::vector<double> dips = with_dips(2, 1, 0.5, {90});
    std::vector<double> logs;
    for (const double value : dips) logs.push_back(log(value + 1e-5));
    assert_true(import_table(rows(dips, "\n"), LENSPROF_FORMAT_CURVES, 0, LENSPROF_CURVE_FORWARD).change > 0.2);
    assert_true(import_table(rows(logs, "\n"), LENSPROF_FORMAT_CURVES, 0, LENSPROF_CURVE_LOG).change > 0.2);
}

// Values that are not a response: falling, noise, a peak, a constant.
void test_no_response(void **) {
    std::vector<std::vector<double>> tables(5);
    uint64_t random = 5;
    for (int i = 0; i < 256; i++) {
        tables[0].push_back(255 - i);
        tables[1].push_back(255 * lp_random(&random));
        tables[2].push_back(255 * sin(M_PI * i / 255.0));
        tables[3].push_back(7);
        tables[4].push_back(i == 128 ? 0 : i);
    }
    for (const auto &table : tables)
        for (const uint32_t format : {LENSPROF_FORMAT_PCALIB, LENSPROF_FORMAT_CURVES}) {
            assert_int_equal(import_table(rows(table, "\n"), format).status, LENSPROF_ERROR_RESPONSE);
        }
}

// An inverse curve stays below 0 when its dips are removed: 0, then eight times -0.05.
void test_repaired_below_zero(void **) {
    for (const double start : {0.0, 0.01})
        for (const double scale : {1.0, 255.0}) {
            std::vector<double> values{start * scale};
            for (int i = 1; i < 256; i++) values.push_back(scale * (i <= 8 ? -0.05 : i / 255.0));
            assert_int_equal(import_table(rows(values, "\n"), LENSPROF_FORMAT_CURVES).status, LENSPROF_ERROR_RESPONSE);
            values[1] = values[0];
            for (int i = 2; i <= 8; i++) values[size_t(i)] = scale * 0.03;
            values[3] = scale * 0.02;
            assert_ok(import_table(rows(values, "\n"), LENSPROF_FORMAT_CURVES).status);
        }
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dips),
        cmocka_unit_test(test_no_response),
        cmocka_unit_test(test_layouts),
        cmocka_unit_test(test_channels),
        cmocka_unit_test(test_kinds),
        cmocka_unit_test(test_pfstools),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_repaired_below_zero),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
