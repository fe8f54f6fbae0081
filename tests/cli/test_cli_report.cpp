// Reports as web pages: `lensprof report` and the option `--report`.
#include "calibrate_runs.hpp"

#include <lensprof/lensprof.h>

using namespace calibrate_runs;

namespace {

// The JSON in a page.
Json data_of(const std::string &path) {
    const std::string text = text_of(path), start = "id=\"data\">", end = "</script>";
    const size_t from = text.find(start) + start.size();
    assert_true(from > start.size());
    return parsed(text.substr(from, text.find(end, from) - from));
}

// Width and height of a JPEG in a data URL: the frame header follows the quantisation tables (ITU-T T.81).
void assert_jpeg(const Json &url) {
    const std::string text = url.get<std::string>(), start = "data:image/jpeg;base64,";
    assert_int_equal(text.compare(0, start.size(), start), 0);
    assert_int_equal(text.compare(start.size(), 3, "/9j"), 0);  // SOI and the next marker's first byte
    assert_true(text.size() > 1000);
}

void test_fit(void **) {
    const Words build = Words{"build", scene("pano.pto"), "--no-store", "--fit", "seed=3"} + quick;
    must_exit(done, build + Words{"--report", work("a.html")});
    must_exit(done, build + Words{"--report", work("b.html")});
    const Json page = data_of(work("a.html")), result = json_of(build + Words{"--json"});
    assert_true(page["result"]["images"] == result["images"]);
    assert_int_equal(page["images"].size(), 4);
    assert_int_equal(page["views"].size(), 5);  // the mosaic, and every picture
    for (const Json &view : page["views"]) {
        assert_jpeg(view["before"]);
        assert_jpeg(view["after"]);
        assert_true(view["before"] != view["after"]);
    }
    // The curve is that of the result, and the pairs' own points lie on it.
    const Json &curve = page["falloffs"][0], &points = page["falloff_points"];
    assert_int_equal(page["falloffs"].size(), result["vignetting"]["k"].size());
    assert_true(points.size() >= 5);
    const Json &green = page["falloffs"][page["falloffs"].size() / 2];
    for (const Json &point : points) {
        const auto at = static_cast<size_t>(std::lround(point["r"].get<double>() * 100));
        assert_true(std::fabs(point["m"].get<double>() - green["m"][at].get<double>()) < 0.05);
    }
    assert_int_equal(curve["m"].size(), 101);
    assert_true(page["responses"][0]["f"].back() == 1.0);
    // Deterministic except for the name in the command, and without network access.
    Json other = data_of(work("b.html"));
    assert_true(contains(page["command"], "lensprof build ") && contains(page["command"], "--fit seed=3"));
    other["command"] = page["command"];
    other["result"]["seconds"] = page["result"]["seconds"];
    assert_true(other == page);
    for (const char *foreign : {"src=\"http", "href=\"http", "url(http", "@import"})
        assert_false(contains(text_of(work("a.html")), foreign));
}

// After correction, pairs are closer to the diagonal, and residuals are about 0.
void test_residuals(void **) {
    must_exit(done, Words{"build", scene("pano.pto"), "--no-store", "--report", work("a.html")} + quick);
    const Json page = data_of(work("a.html")), &figures = page["residuals"];
    const auto scatter = [](const Json &histogram) {
        double sum = 0.0, count = 0.0;
        for (const Json &cell : histogram["cells"]) {
            const double off = cell[0].get<double>() - cell[1].get<double>(), n = cell[2].get<double>();
            sum += off * off * n, count += n;
        }
        return std::sqrt(sum / count);
    };
    assert_true(scatter(figures["joint_after"]) < 0.4 * scatter(figures["joint_before"]));
    size_t used = 0;
    for (const char *by : {"by_radius", "by_grey"})
        for (const Json &bin : figures[by]) {
            if (bin["mean"].is_null()) continue;
            used++;
            assert_true(std::fabs(bin["mean"].get<double>()) < 3.0);
        }
    assert_true(used > 15);
    size_t samples = 0, ends = 0;
    for (const Json &count : figures["frame"]["count"]) samples += count.get<size_t>();
    for (const Json &cell : figures["joint_before"]["cells"]) ends += 2 * cell[2].get<size_t>();
    assert_int_equal(samples, ends);
}

// Names that would end the script, or are not UTF-8, are treated as text.
void test_names(void **) {
    const std::string folder = copy_of("scene", "<!--<script>'x");
    const std::string out = work("r.html");
    const Outcome outcome = run_words(Words{"report", folder + "/pano.pto", "-o", out});
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.out, "wrote " + out));
    const std::string text = text_of(out);
    assert_false(contains(text, "<!--<script>"));
    const Json page = data_of(out);
    assert_true(contains(page["command"], "'\\''x"));  // quoted for a shell
}

// Marks of the template in a title are treated as text; the page is UTF-8 whatever the name.
void test_titles(void **) {
    for (const char *name : {"@DATA@", "@SCRIPT@", "a\xff"}) {
        const std::string folder = copy_of("scene", name);
        fs::copy_file(folder + "/pano.pto", folder + "/" + name + ".pto");
        must_exit(done, Words{"build", folder + "/" + name + ".pto", "--no-store", "--report", work("r.html")} + quick);
        const Json page = data_of(work("r.html"));
        assert_string_equal(page["kind"].get<std::string>().c_str(), "fit");
        const std::string text = text_of(work("r.html"));
        assert_true(text.find("function fitPage") == text.rfind("function fitPage"));
        assert_false(contains(text, "\xff"));
    }
}

// A report shows stored profiles, with their warnings.
void test_stored(void **) {
    const Words build = {"build", scene("pano.pto"), "--camera", "C", "--lens", "L", "--db", work("a.db")};
    must_exit(done, build + Words{"--report", work("r.html")} + quick);
    assert_int_equal(data_of(work("r.html"))["result"]["profile"].get<int>(), 1);
    // An older file is not listed as a written report.
    fs::create_directories(work("one"));
    fs::copy_file(scene("img000.png"), work("one/img000.png"));
    const Outcome outcome = run_words({"report", work("one"), "-o", work("r.html")});
    assert_int_equal(outcome.code, not_usable);
    assert_false(contains(outcome.out, "wrote"));
    save_text(work("mine.html"), "<p>mine</p>");
    assert_refused(usage, build + Words{"--report", work("mine.html")}, {"mine.html", "not a report"});
}

void store_one(const std::string &db, double aperture) {
    const std::string file = work("k.csv");
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    std::strcpy(profile->key.camera_model, "Example <1>");
    std::strcpy(profile->key.lens, "Lens 50mm");
    profile->key.focal_mm = 50, profile->key.aperture = aperture;
    profile->vignetting[0].k[0] = -0.6 / aperture;
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(db.c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    assert_ok(lensprof_store_put(store, profile.get(), nullptr, nullptr));
    lensprof_store_close(store);
}

void test_database(void **) {
    const std::string db = work("a.db"), out = work("r.html");
    for (double aperture : {1.8, 2.8, 5.6}) store_one(db, aperture);
    must_exit(done, {"report", db, "-o", out});
    const Json page = data_of(out);
    assert_string_equal(page["kind"].get<std::string>().c_str(), "database");
    assert_string_equal(page["verdict"]["headline"].get<std::string>().c_str(), "3 usable profiles of 1 lens.");
    assert_true(contains(page["command"], "lensprof report"));
    assert_int_equal(page["lenses"].size(), 1);
    const Json &settings = page["lenses"][0]["settings"];
    assert_int_equal(settings.size(), 3);
    for (const Json &setting : settings)
        assert_float_equal(setting["k"][0].get<double>(), -0.6 / setting["aperture"].get<double>(), 1e-9);
    // One of the profiles, by id and by name.
    for (const Words &which : {Words{"--profile", "2"}, Words{"--lens", "Lens 50mm", "--aperture", "2.8"}}) {
        must_exit(done, Words{"report", "--db", db, "-o", out} + which);
        const Json one = data_of(out);
        assert_string_equal(one["kind"].get<std::string>().c_str(), "profile");
        assert_float_equal(one["falloffs"][0]["m"].back().get<double>(), 1 - 0.6 / 2.8, 1e-9);
    }
    // A file of profiles.
    must_exit(done, {"profile", "export", "1", "2", "--db", db, "-o", work("p.json")});
    must_exit(done, {"report", work("p.json"), "-o", out});
    assert_true(contains(data_of(out)["verdict"]["headline"], "2 usable profiles"));
}

// A grey RGB picture of 320 x 240 from value(x, y), 0..1.
template <class Value>
void write_grey(const std::string &path, const Value &value) {
    Picture picture;
    picture.width = 320, picture.height = 240;
    picture.row_bytes = size_t(3) * picture.width;
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t x = 0; x < picture.width; x++)
            picture.pixels.insert(picture.pixels.end(), 3,
                                  uint8_t(std::lround(255 * std::clamp(value(x, y), 0.0, 1.0))));
    write_picture(path, picture);
}

// M = 1 - 0.3 r^2 on a card.
void test_flat(void **) {
    write_grey(work("card.png"), [](uint32_t x, uint32_t y) {
        const double r2 = (std::pow(x - 159.5, 2) + std::pow(y - 119.5, 2)) / (200.0 * 200.0);
        return 0.8 * (1 - 0.3 * r2);
    });
    const Words flat = {"flat", work("card.png"), "--linear", "--no-store"};
    must_exit(done, flat + Words{"--report", work("r.html")});
    const Json page = data_of(work("r.html"));
    assert_float_equal(page["falloffs"][0]["m"].back().get<double>(), 0.7, 0.01);
    assert_true(page["result"]["usable"] == true);
    const Json &images = page["result"]["images"];
    assert_true(images.size() == 1 && contains(images[0]["file"], "card.png") && page["result"]["gain_grid"].is_null());
    assert_true(page["verdict"]["level"] == "good" && page["verdict"]["details"].empty());
    assert_true(contains(page["verdict"]["notes"].dump(), "of the light from the centre"));
    must_exit(done, flat + Words{"--report", work("r.html"), "--card", "40,30,240,180"});
    const Json part = data_of(work("r.html"))["verdict"];  // a warning
    assert_true(part["level"] == "warn" && contains(part["details"].dump(), "extrapolated"));
    must_exit(done, flat + Words{"--report", work("r.html"), "--fit", "grid=always"});
    const Json grid = data_of(work("r.html"))["result"]["gain_grid"];
    const Json &rows = grid["attenuation"][0];
    assert_true(rows.size() == grid["rows"] && rows[0].size() == grid["columns"] && rows.size() * rows[0].size() > 100);
    assert_refused(usage, flat + Words{"--report", work("card.png")}, {"card.png", ".html"});
}

void test_bracket(void **) {
    Words files;
    for (int i = 0; i < 3; i++) {
        files.push_back(work(std::to_string(i) + ".png"));
        write_grey(files.back(), [i](uint32_t x, uint32_t y) {
            return std::pow(0.02 * std::exp2(2 * i) * (1 + (x * 7 + y * 3) % 320 / 20.0) / 4.0, 1 / 2.2);
        });
    }
    must_exit(done, Words{"bracket"} + files + Words{"--ev", "0,2,4", "--no-store", "--report", work("r.html")});
    const Json page = data_of(work("r.html"));
    assert_int_equal(page["images"].size(), 3);
    assert_float_equal(page["images"][2]["ev"].get<double>() - page["images"][0]["ev"].get<double>(), 4.0, 0.2);
    assert_true(page["falloffs"].empty() && page["responses"].size() == 1);
    assert_float_equal(page["responses"][0]["f"][32].get<double>(), std::pow(0.5, 1 / 2.2), 0.03);
}

void test_refusals(void **) {
    const std::string db = work("a.db"), out = work("r.html");
    store_one(db, 2.8);
    const std::string before = text_of(db);
    assert_refused(usage, {"report", db, "-o", work("r.pdf")}, {"r.pdf", ".html"});
    assert_refused(usage, {"report", db, scene("img000.png"), "-o", out}, {"img000.png", "database"});
    assert_refused(usage, {"report", db, "--images", work(""), "-o", out}, {"--images", "leave it out"});
    assert_refused(usage, {"report", db, "--db", db, "-o", out}, {"--db", "not both"});
    assert_refused(usage, Words{"build", scene("pano.pto"), "--no-store", "--report", work("a.png")},
                   {"a.png", ".html"});
    assert_refused(not_found, {"report", "--db", db, "--profile", "9", "-o", out}, {"9"});
    assert_refused(unreadable, {"report", work("none.pto"), "-o", out}, {"none.pto"});
    assert_refused(unreadable, {"report", work("none.db"), "-o", out}, {"none.db"});
    save_text(work("empty.html"), "");
    save(work("cut.db"), Bytes(before.begin(), before.begin() + 3000));
    assert_refused(store_failed, {"report", work("cut.db"), "-o", work("empty.html")}, {"cut.db"});
    assert_true(text_of(work("empty.html")).empty());
    assert_true(text_of(db) == before);
    assert_false(fs::exists(out));
}

// A folder: its panoramas with their charts, all pictures, and the reasons; the same page if all is done already.
void test_folder(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "4", "--seed", "21"});
    simulate("single", {"--images", "2", "--seed", "23"});
    fs::copy_file(work("single/img000.png"), work("row/other.png"));
    save_text(work("row/bad.png"), text_of(work("row/img002.png")).substr(0, 5000));
    const Words calibrate = {"calibrate", work("row"), "-o", work("out"), "--db", work("p.db")};
    const Words report = {"--report", work("folder.html")};
    must_exit(done, calibrate + report);
    const Json page = data_of(work("folder.html"));
    assert_true(page["kind"] == "folder" && page["verdict"]["level"] == "warn");
    assert_true(page["verdict"]["headline"] == "5 of 6 pictures are corrected.");
    assert_int_equal(page["views"].size(), 6);  // a mosaic and five pictures
    for (const Json &view : page["views"]) {
        assert_jpeg(view["before"]);
        assert_true(view["before"] != view["after"]);
    }
    assert_int_equal(page["panoramas"].size(), 1);
    const Json &fit = page["panoramas"][0]["page"];
    assert_true(fit["verdict"]["level"] == "good" && fit["images"].size() == 4 && fit["falloffs"].size() >= 1);
    assert_true(page["looked_up"][0]["name"] == "other.png");
    assert_true(contains(page["looked_up"][0]["correction"], "profile"));
    assert_true(contains(page["left_out"][0]["reason"], "bad.png"));
    assert_true(page["result"] == parsed(text_of(work("out/calibrate.json"))));

    // What somebody puts instead of a mosaic is never more than a picture that is not shown; a copy is not read.
    const std::string mosaic = page["result"]["panoramas"][0]["preview"].get<std::string>();
    const std::string kept = text_of(mosaic), copy = text_of(work("out/other.png"));
    for (auto [width, height] : {std::pair(3000u, 1u), std::pair(3000u, 9u), std::pair(2u, 3000u)}) {
        Picture other;
        other.width = other.frame_width = width, other.height = other.frame_height = height;
        other.sample = LENSPROF_SAMPLE_U16, other.layout = LENSPROF_LAYOUT_RGBA;
        other.row_bytes = size_t(8) * width;
        other.pixels.assign(other.row_bytes * height, 77);
        write_picture(work("other_mosaic.png"), other);
        save_text(mosaic, text_of(work("other_mosaic.png")));
        must_exit(done, calibrate + report);
        const size_t views = data_of(work("folder.html"))["views"].size();
        assert_true(views == (height > 9 ? 6 : 5));
    }
    save_text(mosaic, kept);
    must_exit(done, calibrate + report);
    const std::string first = text_of(work("folder.html"));
    save_text(work("out/other.png"), "");
    must_exit(done, calibrate + report);
    assert_true(text_of(work("folder.html")) == first);
    save_text(work("out/other.png"), copy);
    fs::remove_all(work("out"));
    const Words to_page = {"calibrate", work("row"), "--no-store", "-o"};
    assert_refused(usage, to_page + Words{work("x.html"), "--report", work("x.html")}, {"x.html", "output folder"});
    assert_refused(usage, to_page + Words{work("x.html/o"), "--report", work("x.html")}, {"x.html", "output folder"});
    assert_false(fs::exists(work("x.html")));
    assert_refused(usage, calibrate + Words{"--report", work("row/img000.png")}, {"img000.png", ".html"});
    save_text(work("mine.html"), "mine");
    assert_refused(usage, calibrate + Words{"--report", work("mine.html")}, {"mine.html", "not a report"});
    assert_false(fs::exists(work("out")));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {CLI_TEST(test_fit),     CLI_TEST(test_residuals), CLI_TEST(test_names),
                                CLI_TEST(test_titles),  CLI_TEST(test_stored),    CLI_TEST(test_database),
                                CLI_TEST(test_flat),    CLI_TEST(test_bracket),   CLI_TEST(test_folder),
                                CLI_TEST(test_refusals)};
    return cmocka_run_group_tests_name("report", tests, make_scene, remove_folder);
}
