// Relative illuminance charts: `lensprof profile show --chart`.
#include "cli_runs.hpp"

#include <lensprof/lensprof.h>

using namespace cli_runs;

// What fontconfig keeps for the life of the process is not a leak of lensprof; LeakSanitizer reads this list.
extern "C" const char *__lsan_default_suppressions();
extern "C" const char *__lsan_default_suppressions() { return "leak:libfontconfig"; }

namespace {

constexpr double steep[3] = {-0.35, 0.12, -0.17};  // M(1) = 0.6

struct Setting {
    const char *camera;
    double focal_mm, aperture;
    uint32_t vignettings;
    bool has_covariance;
    uint32_t modes = 0;  // above 0: number of modes of each of three responses
};

// Variances of k1..k3 and the covariance of k1 and k2, after the coefficients of the responses.
constexpr double variance[3] = {4e-4, 9e-4, 4e-4}, covariance12 = -3e-4;

double light(const double *k, double r) {
    const double s = r * r;
    return 1 + k[0] * s + k[1] * s * s + k[2] * s * s * s;
}

double error_of_light(double r) {
    const double s = r * r;
    return std::sqrt(variance[0] * s * s + variance[1] * s * s * s * s + variance[2] * std::pow(s, 6)
                     + 2 * covariance12 * s * s * s);
}

// Falloff number i of a setting is `steep` times 1 - 0.3 i.
void put(lensprof_store *store, const Setting &setting) {
    auto p = std::make_unique<lensprof_profile>();
    lensprof_profile_init(p.get());
    std::strcpy(p->key.camera_model, setting.camera);
    std::strcpy(p->key.lens, "Lens");
    p->key.focal_mm = setting.focal_mm;
    p->key.aperture = setting.aperture;
    p->vignettings = setting.vignettings;
    for (uint32_t c = 0; c < 3; c++)
        for (int n = 0; n < 3 && c < setting.vignettings; n++) p->vignetting[c].k[n] = steep[n] * (1 - 0.3 * c);
    if (setting.has_covariance) {
        const uint32_t first = 3 * setting.modes, size = p->covariance_size = first + 5;
        for (uint32_t n = 0; n < first; n++) p->covariance[(size + 1) * n] = 0.1;
        for (uint32_t n = 0; n < 3; n++) p->covariance[(size + 1) * (first + n)] = variance[n];
        p->covariance[first * size + first + 1] = p->covariance[(first + 1) * size + first] = covariance12;
    }
    const std::vector<double> coefficients(setting.modes);
    if (setting.modes) p->responses = 3;
    for (uint32_t c = 0; c < 3 && setting.modes; c++)
        assert_ok(lensprof_response_set_emor(&p->response[c], coefficients.data(), setting.modes));
    lensprof_error error{};
    if (lensprof_store_put(store, p.get(), nullptr, &error) != LENSPROF_OK) fail_msg("%s", error.text);
}

std::string make_db(const std::vector<Setting> &settings) {
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work("p.db").c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    for (const Setting &setting : settings) put(store, setting);
    lensprof_store_close(store);
    return work("p.db");
}

std::string line_with(const std::string &text, const std::string &part) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (contains(line, part)) return line;
    fail_msg("no line with %s in %s", part.c_str(), text.c_str());
    return {};
}

void check_terminal(uint32_t modes) {
    const std::string db = make_db({{"Camera", 28, 2.8, 1, true, modes}, {"Camera", 28, 8, 1, false}});
    const std::string text = must_exit(done, {"profile", "show", "1", "2", "--chart", "--db", db});
    assert_true(contains(text, "\nCamera, Lens, 28 mm, jpeg\n"));
    char expected[64];
    for (double r : {0.25, 0.5, 0.75, 1.0}) {
        std::snprintf(expected, sizeof expected, "%.3f +- %.3f", light(steep, r), error_of_light(r));
        assert_true(contains(line_with(text, "a  f/2.8"), expected));
    }
    const std::string table = must_exit(done, {"profile", "show", "1", "--db", db});
    std::snprintf(expected, sizeof expected, "r = 0.5: %.1f +- %.1f %%, in the corner: %.1f +- %.1f %%",
                  100 * light(steep, 0.5), 100 * error_of_light(0.5), 100 * light(steep, 1), 100 * error_of_light(1));
    assert_true(contains(table, expected));
    assert_true(contains(line_with(text, "b  f/8"), "  0.600"));
    assert_false(contains(line_with(text, "b  f/8"), "+-"));
    assert_true(contains(text.substr(text.find("a  f/2.8")), "-0.74\n"));  // log2 0.6
    // 72 columns from r = 0 at column 10: the curves coincide, and the first one's letter is shown.
    assert_true(line_with(text, "       1 +").at(10) == 'a');
    assert_int_equal(line_with(text, "     0.6 +").size(), 10 + 72 + 1);
    for (char c : text) assert_true(c == '\n' || (c >= ' ' && c <= '~'));
    assert_false(contains(text, " \n"));
}

void test_terminal(void **) { check_terminal(0); }

void test_three_responses(void **) { check_terminal(2); }

void test_json(void **) {
    const std::string db = make_db({{"Camera", 28, 2.8, 1, true}, {"Camera", 28, 4, 3, false}});
    const Json all =
        json_of({"profile", "show", "--lens", "lens", "--chart", "--channel", "all", "--json", "--db", db});
    assert_int_equal(all["curves"].size(), 4);
    const Json &first = all["curves"][0];
    assert_string_equal(first["label"].get<std::string>().c_str(), "f/2.8");
    assert_true(first["channel"].is_null() && all["curves"][1]["sigma"].is_null());
    for (size_t i = 0; i <= 20; i++) {
        const double r = first["r"][i].get<double>();
        assert_close(r, 0.05 * double(i), 1e-12);
        assert_close(first["m"][i].get<double>(), light(steep, r), 1e-12);
        assert_close(first["sigma"][i].get<double>(), error_of_light(r), 1e-12);
        assert_close(first["ev"][i].get<double>(), std::log2(light(steep, r)), 1e-12);
    }
    const char *const channels[] = {"red", "green", "blue"};
    for (size_t c = 0; c < 3; c++) {
        const Json &curve = all["curves"][c + 1];
        assert_string_equal(curve["label"].get<std::string>().c_str(), (std::string("f/4, ") + channels[c]).c_str());
        assert_string_equal(curve["channel"].get<std::string>().c_str(), channels[c]);
        assert_close(curve["m"][20].get<double>(), 1 - 0.4 * (1 - 0.3 * double(c)), 1e-12);
    }
}

// Labels contain what differs between the curves; green represents three channels when profiles are compared.
void test_labels_and_channels(void **) {
    const std::string db = make_db({{"A", 28, 2.8, 3, false},
                                    {"A", 50, 2.8, 1, false},
                                    {"A", 50, 2.8, 1, false},
                                    {"B", 28, LENSPROF_UNKNOWN, 1, false}});
    const auto labels = [&](const Words &more) {
        const Json json = json_of(Words{"profile", "show", "--chart", "--json", "--db", db} + more);
        std::string text;
        for (const Json &curve : json["curves"]) text += curve["label"].get<std::string>() + ";";
        return text;
    };
    assert_string_equal(labels({"1"}).c_str(), "red;green;blue;");
    assert_string_equal(labels({"1", "--channel", "blue"}).c_str(), "blue;");
    assert_string_equal(labels({"2"}).c_str(), "profile 2;");
    assert_string_equal(labels({"2", "3"}).c_str(), "profile 2;profile 3;");
    assert_string_equal(labels({"--camera", "a"}).c_str(), "28 mm, green;50 mm, profile 2;50 mm, profile 3;");
    assert_string_equal(labels({"4", "1"}).c_str(), "B, aperture unknown;A, f/2.8, green;");
    assert_string_equal(labels({"--camera", "A", "--focal", "28"}).c_str(), "red;green;blue;");
}

// Without --chart several profiles are printed in sequence.
void test_several_without_chart(void **) {
    const std::string db = make_db({{"A", 28, 2.8, 1, false}, {"A", 28, 4, 1, false}});
    const std::string text = must_exit(done, {"profile", "show", "--camera", "A", "--db", db});
    assert_true(contains(text, "profile   1: A, Lens, 28 mm, f/2.8"));
    assert_true(contains(text, "profile   2: A, Lens, 28 mm, f/4"));
    assert_int_equal(json_of({"profile", "show", "1", "2", "--json", "--db", db})["profiles"].size(), 2);
    assert_int_equal(json_of({"profile", "show", "2", "--json", "--db", db})["id"].get<int>(), 2);
}

// A gain grid is not a function of the radius; it is mentioned below the chart.
void test_gain_grid(void **) {
    const std::string db = make_db({{"A", 28, 2.8, 1, true}, {"A", 28, 4, 1, false}});
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(db.c_str(), LENSPROF_STORE_WRITE, &store, nullptr));
    auto p = std::make_unique<lensprof_profile>();
    lensprof_profile_init(p.get());
    assert_ok(lensprof_store_get(store, 2, p.get(), nullptr));
    p->grid.columns = 3, p->grid.rows = 2, p->grid.channels = 3;
    for (int i = 0; i < 18; i++) p->grid.attenuation[i] = 1.0f + 0.125f * float(i % 7 - 3);
    assert_ok(lensprof_store_put(store, p.get(), nullptr, nullptr));
    lensprof_store_close(store);

    const std::string text = must_exit(done, {"profile", "show", "3", "--db", db});
    const char *const shown =
        "\n"
        "gain grid 3 x 2 nodes, one grid per channel; multiplies the falloff by 0.625 to 1.375\n";
    assert_true(contains(text, shown));
    assert_false(contains(must_exit(done, {"profile", "show", "2", "--db", db}), "gain grid"));
    const Json grid = json_of({"profile", "show", "3", "--json", "--db", db})["gain_grid"];
    assert_int_equal(grid["columns"].get<int>(), 3);
    assert_int_equal(grid["rows"].get<int>(), 2);
    for (int i = 0; i < 18; i++)
        assert_close(grid["attenuation"][size_t(i / 6)][size_t(i / 3 % 2)][size_t(i % 3)].get<double>(),
                     1 + 0.125 * (i % 7 - 3), 0);
    assert_true(json_of({"profile", "show", "2", "--json", "--db", db})["gain_grid"].is_null());

    const std::string note = "without the gain grid of profile 3";
    const Words chart = {"profile", "show", "1", "3", "--chart", "--db", db};
    assert_true(contains(must_exit(done, chart), "\n" + note + "\n"));
    assert_string_equal(json_of(chart + Words{"--json"})["note"].get<std::string>().c_str(), note.c_str());
    const std::string twice = must_exit(done, {"profile", "show", "3", "3", "--chart", "--db", db});
    assert_true(contains(twice, "without the gain grids of profiles 3, 3\n"));
    assert_false(contains(must_exit(done, {"profile", "show", "1", "2", "--chart", "--db", db}), "without"));
    must_exit(done, chart + Words{"--chart-out", work("a.svg")});
    must_exit(done, {"profile", "show", "1", "2", "--chart-out", work("b.svg"), "--db", db});
    assert_true(text_of(work("a.svg")).size() > text_of(work("b.svg")).size());  // the note
}

// Checks the tags of an XML document: each opening tag is closed, in order.
void assert_well_formed(const std::string &xml) {
    assert_int_equal(xml.rfind("<?xml version=\"1.0\" encoding=\"UTF-8\"?>", 0), 0);
    std::vector<std::string> open;
    size_t elements = 0;
    for (size_t at = xml.find('<', 1); at != std::string::npos; at = xml.find('<', at + 1)) {
        const size_t end = xml.find('>', at);
        assert_true(end != std::string::npos && xml.find('<', at + 1) > end);
        const std::string tag = xml.substr(at + 1, end - at - 1), name = tag.substr(0, tag.find_first_of(" \n/", 1));
        if (tag[0] == '/') {
            assert_true(!open.empty() && "/" + open.back() == name);
            open.pop_back();
        } else if (tag.back() != '/') {
            open.push_back(name);
        }
        assert_int_equal(std::count(tag.begin(), tag.end(), '"') % 2, 0);
        elements++;
    }
    assert_true(open.empty() && elements > 50);
}

// Width and height of the drawing.
std::pair<uint32_t, uint32_t> size_of_svg(const std::string &svg) {
    const auto found = find_pattern("viewBox=\"0 0 ([0-9]+) ([0-9]+)\"", svg);
    assert_int_equal(found.size(), 4);
    const auto number = [&](size_t i) { return uint32_t(std::stoul(svg.substr(found[i].first, found[i].second))); };
    return {number(1), number(2)};
}

void test_svg(void **) {
    const std::string db = make_db({{"A & <B>", 28, 2.8, 1, true}, {"A & <B>", 28, 4, 3, false}});
    const Words words = {"profile", "show", "1", "2", "--db", db, "--chart-out"};
    for (const char *name : {"a.svg", "b.SVG"}) {  // a separate process per run
        const Outcome outcome = run_child(words + Words{work(name)});
        assert_int_equal(outcome.code, done);
        assert_true(contains(outcome.out, work(name)));
    }
    const std::string svg = text_of(work("a.svg"));
    assert_string_equal(svg.c_str(), text_of(work("b.SVG")).c_str());
    assert_well_formed(svg);
    assert_true(size_of_svg(svg).first > 650 && size_of_svg(svg).second > 450);
    for (const char *colour : {"rgb(0%,44.7%,69.8%)", "rgb(83.5%,36.9%,0%)"}) assert_true(contains(svg, colour));
    assert_true(contains(svg, "dasharray"));
    assert_int_equal(files_in_folder(), 3);  // scene, mixed and work: nothing else was written
}

// Red, green and blue of a pixel; point (x, y) of the drawing is at pixel (2x, 2y).
std::array<int, 3> pixel_at(const Picture &picture, double x, double y) {
    const uint8_t *p = picture.pixels.data() + size_t(2 * y) * picture.row_bytes + size_t(2 * x) * 3;
    return {p[0], p[1], p[2]};
}

// The plot is 520 x 360 points and starts at (70, 64); M goes from 0.5 to 1.
void test_png(void **) {
    const std::string db = make_db({{"A", 28, 2.8, 1, true}, {"A", 28, 4, 3, false}});
    const Words words = {"profile", "show", "1", "2", "--channel", "red", "--db", db, "--chart-out"};
    must_exit(done, {"profile", "show", "1", "--db", db, "--chart-out", work("one.png")});
    for (const char *name : {"a.png", "b.png", "a.svg"}) must_exit(done, words + Words{work(name)});
    assert_true(load(work("a.png")) == load(work("b.png")));
    const auto size = size_of_svg(text_of(work("a.svg")));
    const Picture both = read_picture(work("a.png")), one = read_picture(work("one.png"));
    assert_int_equal(both.width, 2 * size.first);
    assert_int_equal(both.height, 2 * size.second);
    const std::array<int, 3> white = {255, 255, 255}, blue = {0, 114, 178};
    for (double r : {0.3, 0.6, 0.8, 0.95}) {
        const double x = 70 + 520 * r, y = 64 + 360 * (1 - light(steep, r)) / 0.5;
        const auto curve = pixel_at(one, x, y);
        for (size_t c = 0; c < 3; c++) assert_true(std::abs(curve[c] - blue[c]) < 12);
        assert_true(pixel_at(one, x, 64 + 351) == white);
        const double sigma = 360 * error_of_light(r) / 0.5;  // the band is light: 15 % of the colour
        const auto within = pixel_at(one, x, y + 0.7 * sigma), beyond = pixel_at(one, x, y + 1.3 * sigma + 1);
        if (sigma > 5) assert_true(within[0] > 200 && within[0] < 225 && within[2] > 235 && beyond[0] > within[0]);
    }
}

void test_usage(void **) {
    const std::string db = make_db({{"A", 28, 2.8, 1, true}, {"A", 28, 4, 3, false}});
    const Words show = {"profile", "show", "--db", db};
    assert_refused(usage, show, {"profile list"});
    assert_refused(usage, show + Words{"1", "--camera", "A"}, {"give ids"});
    assert_refused(usage, show + Words{"0"}, {});
    assert_refused(usage, show + Words{"x"}, {});
    assert_refused(usage, show + Words{"1", "--channel", "green"}, {"--channel", "--chart"});
    assert_refused(usage, show + Words{"1", "--chart", "--channel", "ultraviolet"}, {"ultraviolet"});
    assert_refused(usage, show + Words{"--camera", "A", "--key", "processing=cooked"}, {"cooked"});
    for (const char *name : {"chart.jpg", "chart", ".png", "svg"})
        assert_refused(usage, show + Words{"1", "--chart-out", work(name)}, {name, ".svg or .png"});
    assert_refused(usage, {"profile", "list", "--chart", "--db", db}, {"--chart"});
    assert_refused(usage, {"profile", "list", "1", "--db", db}, {"1: unexpected argument", "profile list --help"});
    assert_refused(usage, {"profile", "remove", "1", "--camera", "A", "--db", db}, {"give ids", "--camera"});
    assert_refused(usage, {"profile", "remove", "--db", db}, {"profile list"});
    assert_refused(usage, {"profile", "remove", "1", "--chart-out", work("a.png"), "--db", db}, {"--chart-out"});
}

void test_refused_files(void **) {
    const std::string db = make_db({{"A", 28, 2.8, 1, true}}), picture = work("p.png");
    assert_refused(not_found, {"profile", "show", "7", "--chart-out", picture, "--db", db}, {db, "7"});
    assert_refused(not_found, {"profile", "show", "1", "7", "--chart", "--db", db}, {db, "7"});
    assert_refused(not_found, {"profile", "show", "--camera", "Z", "--chart-out", picture, "--db", db}, {"Z", db});
    assert_refused(not_found, {"profile", "show", "1", "--chart", "--db", work("none.db")}, {work("none.db")});
    assert_refused(failed, {"profile", "show", "1", "--chart-out", work("none/a.svg"), "--db", db}, {"none/a.svg"});
    fs::create_directories(work("folder.png"));
    assert_refused(usage, {"profile", "show", "1", "--chart-out", work("folder.png"), "--db", db}, {"folder.png"});
    // The database itself, through a link with the extension of a picture.
    fs::create_symlink(db, work("link.svg"));
    assert_refused(usage, {"profile", "show", "1", "--chart-out", work("link.svg"), "--db", db}, {"link.svg"});
    fs::rename(db, work("db.png"));
    assert_refused(usage, {"profile", "show", "1", "--chart-out", work("db.png"), "--db", work("db.png")}, {"db.png"});
}

// A read-only folder, and a full disk.
void test_unwritable(void **) {
    const std::string db = make_db({{"A", 28, 2.8, 1, true}});
    const Words words = {"profile", "show", "1", "--chart-out", work("a.png"), "--db", db};
    const Disk before = disk();
    assert_refusal(words,
                   run_child(words,
                             [] {
                                 signal(SIGXFSZ, SIG_IGN);
                                 const rlimit limit = {4096, 4096};
                                 setrlimit(RLIMIT_FSIZE, &limit);
                             }),
                   failed, {work("a.png")}, before);
    if (geteuid() != 0) return;  // only root can change the user
    const mode_t mode = 0755;
    chmod(work("").c_str(), mode);
    const Outcome outcome = run_child(words, [] {
        if (setuid(65534) != 0) _exit(255);
    });
    if (outcome.code != store_failed) assert_refusal(words, outcome, failed, {work("a.png")}, before);
}

void test_too_many(void **) {
    const std::string db = make_db(std::vector<Setting>(25, Setting{"A", 28, 2.8, 1, false}));
    assert_refused(usage, {"profile", "show", "--camera", "A", "--chart-out", work("a.svg"), "--db", db}, {"25", "24"});
    must_exit(done, {"profile", "remove", "25", "--db", db});
    must_exit(done, {"profile", "show", "--camera", "A", "--chart", "--chart-out", work("a.svg"), "--db", db});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_terminal),
        CLI_TEST(test_three_responses),
        CLI_TEST(test_json),
        CLI_TEST(test_labels_and_channels),
        CLI_TEST(test_several_without_chart),
        CLI_TEST(test_gain_grid),
        CLI_TEST(test_svg),
        CLI_TEST(test_png),
        CLI_TEST(test_usage),
        CLI_TEST(test_refused_files),
        CLI_TEST(test_unwritable),
        CLI_TEST(test_too_many),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
