// The program's commands, in process, on a rendered sequence. Bad input is covered in test_cli_faults.cpp, correction
// of pictures in test_cli_apply.cpp.
#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

// The object without its timings, as text, to compare runs.
std::string timeless(const std::string &json) {
    const std::string text = replaced(json, "\"seconds\":\\{[^}]*\\}", "");
    assert_true(text != json);
    return text;
}

Words build_scene(const Words &more) {
    return Words{"build", scene("pano.pto"), "--no-store", "--json"} + quick + more;
}

// Help and version.

void test_help(void **) {
    assert_true(contains(must_exit(usage, {}), "usage: lensprof COMMAND"));
    for (const char *word : {"help", "--help", "-h"}) {
        const std::string help = must_exit(done, {word});
        for (const char *command : {"build", "apply", "query", "profile", "simulate", "version"})
            assert_true(contains(help, std::string("\n  ") + command + " "));
    }
    for (const char *command : {"build", "apply", "query", "profile", "simulate"}) {
        const std::string help = must_exit(done, {"help", command});
        assert_true(contains(help, std::string("lensprof ") + command));
        assert_string_equal(help.c_str(), must_exit(done, {command, "--help"}).c_str());
    }
    must_exit(done, {"help", "version"});
    must_exit(done, {"help", "help"});
}

void test_version(void **) {
    assert_string_equal(must_exit(done, {"version"}).c_str(), "lensprof 0.3.0\n");
    assert_string_equal(must_exit(done, {"--version"}).c_str(), "lensprof 0.3.0\n");
}

void test_unknown_command(void **) {
    for (const Words &words : {Words{"frobnicate"}, Words{"help", "frobnicate"}, Words{"frobnicate", "--help"}})
        assert_refused(usage, words, {"frobnicate", "lensprof help"});
    assert_refused(usage, {"--frobnicate"}, {"--frobnicate"});
    assert_refused(usage, {""}, {"no such command"});
}

// build.

void check_response(const Json &response) {
    assert_int_equal(response.at("values").size(), 1);
    const Json &values = response.at("values")[0];
    assert_int_equal(values.size(), 1024);
    assert_close(values[0].get<double>(), 0, 0);
    assert_close(values[1023].get<double>(), 1, 0);
    for (size_t i = 1; i < 1024; ++i) assert_true(values[i].get<double>() >= values[i - 1].get<double>());
}

void test_build_keeps_its_contract(void **) {
    const Json json = json_of(build_scene({}));
    assert_true(json.at("usable").is_boolean() && json["usable"].get<bool>());
    assert_true(json.at("findings").empty());
    assert_true(json.at("passed").size() > 20);
    for (const Json &rule : json["passed"])
        assert_true(rule.at("code").is_string() && rule.at("measured").is_number() && rule.at("limit").is_number());
    assert_int_equal(json.at("images").size(), 4);
    for (size_t i = 0; i < 4; ++i) {
        const Json &image = json["images"][i];
        assert_string_equal(image.at("file").get<std::string>().c_str(),
                            ("img00" + std::to_string(i) + ".png").c_str());
        assert_true(image.at("ev").is_number());
        assert_int_equal(image.at("white_balance").size(), 3);
        assert_close(image["white_balance"][1].get<double>(), 1, 0);
    }
    assert_int_equal(json.at("vignetting").at("k").size(), 1);
    assert_int_equal(json["vignetting"]["k"][0].size(), 3);
    assert_int_equal(json["vignetting"].at("center").size(), 2);
    check_response(json.at("response"));
    for (const char *key : {"before_rms", "heldout_rms", "inlier_share"})
        assert_true(json.at("residual").at(key).is_number());
    assert_int_equal(json.at("pairs").get<int>(), 600);
    for (const char *key : {"load", "sample", "solve"}) assert_true(json.at("seconds").at(key).get<double>() >= 0);
}

// The result equals the rendered truth up to the exponent g that pictures alone leave open: with another response, EV
// times g, and falloff and white balance to the power g explain the same pictures (Grossberg & Nayar 2003).
void test_build_finds_the_truth(void **) {
    const Json truth = parsed(text_of(scene("truth.json"))),
               json = json_of({"build", scene("pano.pto"), "--no-store", "--json"});
    assert_int_equal(json["pairs"].get<int>(), 2000);
    double ev[4], true_ev[4], cross = 0, square = 0;
    for (size_t i = 0; i < 4; ++i) {
        ev[i] = json["images"][i]["ev"].get<double>();
        true_ev[i] = truth["images"][i]["ev"].get<double>() - truth["images"][0]["ev"].get<double>();
        cross += ev[i] * true_ev[i];
        square += true_ev[i] * true_ev[i];
    }
    const double g = cross / square;
    assert_close(g, 1, 0.3);
    for (size_t i = 0; i < 4; ++i) {
        assert_close(ev[i] / g, true_ev[i], 0.02);
        for (size_t c : {0u, 2u})
            assert_close(std::pow(json["images"][i]["white_balance"][c].get<double>(), 1 / g),
                         truth["images"][i]["white_balance"][c].get<double>(), 0.02);
    }
    const auto light = [](const Json &k, double r2) {
        return 1 + r2 * (k[0].get<double>() + r2 * (k[1].get<double>() + r2 * k[2].get<double>()));
    };
    for (double r2 : {0.25, 0.5, 0.8})
        assert_close(std::pow(light(json["vignetting"]["k"][0], r2), 1 / g), light(truth["vignetting"]["k"][0], r2),
                     0.02);
    for (size_t d : {0u, 1u})
        assert_close(json["vignetting"]["center"][d].get<double>(), truth["vignetting"]["center"][d].get<double>(),
                     0.02);
    assert_true(json["residual"]["heldout_rms"].get<double>() < 0.1 * json["residual"]["before_rms"].get<double>());
    assert_true(json["residual"]["inlier_share"].get<double>() > 0.9);
}

void test_build_is_repeatable(void **) {
    const std::string once = must_exit(done, build_scene({}));
    assert_string_equal(timeless(once).c_str(), timeless(must_exit(done, build_scene({}))).c_str());
    assert_string_not_equal(timeless(once).c_str(),
                            timeless(must_exit(done, build_scene({"--fit", "seed=2"}))).c_str());
}

void test_build_table(void **) {
    const std::string table = must_exit(
        done, Words{"build", scene("pano.pto"), "--no-store", "--fit", "truth=" + scene("truth.json")} + quick);
    for (const char *part :
         {"img000.png", "img003.png", "reference", "falloff", "response", "residual", "largest error"})
        assert_true(contains(table, part));
    assert_false(find_pattern("in the corner: [0-9.]+ \\+- [0-9.]+ %", table).empty());
    assert_false(contains(table, "NOT USABLE"));
}

void test_points_replace_pictures(void **) {
    const std::string copy = copy_of("scene", "mit Leer \xc3\xa4"), points = work("points.txt");
    const Words words = Words{"build", copy + "/pano.pto", "--no-store", "--json", "--fit", "exif-sigma=0"} + quick;
    // A point file does not record the links of the pictures.
    const auto fitted = [&](const Words &more) {
        const std::string json = timeless(must_exit(done, words + more));
        return replaced(json, "\"links\":\\[[^;]*\\],\"components\"", "\"components\"");
    };
    const std::string first = fitted({"--write", "points=" + points});
    assert_string_equal(fitted({"--points", points}).c_str(), first.c_str());
    for (int i = 0; i < 4; ++i) fs::remove(copy + "/img00" + std::to_string(i) + ".png");
    assert_string_equal(fitted({"--points", points}).c_str(), first.c_str());

    std::istringstream lines(text_of(points));
    std::string line;
    size_t count = 0;
    for (; std::getline(lines, line); ++count) {
        std::istringstream numbers(line);
        std::vector<double> column;
        for (double number; numbers >> number;) column.push_back(number);
        assert_int_equal(column.size(), 16);
        assert_true(column[0] >= 0 && column[0] < 4 && column[1] >= 0 && column[1] < 4 && column[0] != column[1]);
        assert_true(column[2] >= 0 && column[2] <= 319 && column[3] >= 0 && column[3] <= 239);
        assert_close(column[13], std::hypot(column[2] - 159.5, column[3] - 119.5) / 200, 1e-9);  // half diagonals
    }
    assert_int_equal(count, 600);
}

// The number after `name` on the i line of an image of a project.
double pto_number(const std::string &pto, int image, const std::string &name) {
    std::istringstream lines(pto);
    std::string line;
    while (std::getline(lines, line)) {
        if (line.rfind("i ", 0) != 0 || image-- > 0) continue;
        const auto match = find_pattern(" " + name + "(=?)([-+.0-9e]+)( |$)", line);
        if (match.empty()) fail_msg("no %s in %s", name.c_str(), line.c_str());
        const std::string number = line.substr(match[2].first, match[2].second);
        return match[1].second ? pto_number(pto, std::stoi(number), name) : std::stod(number);
    }
    fail_msg("no image line");
    return 0;
}

void test_project_with_the_result(void **) {
    const std::string copy = copy_of("scene"), pto = copy + "/out.pto";
    edit(copy + "/pano.pto", "Eev0( .*img000)", "Eev7.5$1");  // Hugin counts from an absolute exposure value
    const Json json = json_of(Words{"build", copy + "/pano.pto", "--no-store", "--json", "--fit", "modes=5,pairs=600",
                                    "--write", std::string("pto=") + pto});
    const std::string text = text_of(pto);
    for (int i = 0; i < 4; ++i) {
        const Json &image = json["images"][size_t(i)];
        assert_close(pto_number(text, i, "Eev"), 7.5 - image["ev"].get<double>(), 1e-9);
        assert_close(pto_number(text, i, "Er"), image["white_balance"][0].get<double>(), 1e-9);
        assert_close(pto_number(text, i, "Eb"), image["white_balance"][2].get<double>(), 1e-9);
        assert_close(pto_number(text, i, "Vb"), json["vignetting"]["k"][0][0].get<double>(), 1e-9);
        assert_close(pto_number(text, i, "Vd"), json["vignetting"]["k"][0][2].get<double>(), 1e-9);
        assert_close(pto_number(text, i, "Vx"), json["vignetting"]["center"][0].get<double>() * 200, 1e-6);  // px
        if (json["response"].at("emor").size() == 5) {
            assert_close(pto_number(text, i, "Ra"), json["response"]["emor"][0].get<double>(), 1e-9);
            assert_close(pto_number(text, i, "Re"), json["response"]["emor"][4].get<double>(), 1e-9);
        }
        assert_close(pto_number(text, i, "y"), pto_number(text_of(scene("pano.pto")), i, "y"), 0);
    }
    for (const char *part :
         {"# written by lensprof\n", "\nv Eev1 Er1 Eb1\n", "n\"img003.png\"\n", "\np f2 w3000 h1500"})
        assert_true(contains(text, part));
    json_of(Words{"build", pto, "--no-store", "--json"} + quick);
    must_exit(done, {"apply", "--pto", pto, "-o", work("corrected")});
    assert_int_equal(std::distance(fs::directory_iterator(work("corrected")), fs::directory_iterator()), 4);
}

// Names in a project are relative to its folder.
void test_project_in_another_folder(void **) {
    const std::string copy = copy_of("scene", "pictures");
    fs::create_directories(work("projects/mine"));
    must_exit(done, Words{"build", copy + "/pano.pto", "--no-store", "--write", "pto=" + work("projects/mine/out.pto")}
                        + quick);
    assert_true(contains(text_of(work("projects/mine/out.pto")), "n\"../../pictures/img000.png\""));
    must_exit(done, {"apply", "--pto", work("projects/mine/out.pto"), "-o", work("corrected")});
    assert_true(fs::exists(work("corrected/img003.png")));
}

// Another reference shifts the zero, not the result.
void test_reference(void **) {
    const Json plain = json_of(build_scene({}));
    for (const char *wanted : {"2", "img002.png"}) {
        const Json json = json_of(build_scene({"--fit", std::string("reference=") + wanted}));
        for (size_t i = 0; i < 4; ++i) {
            const Json &image = json["images"][i], &same = plain["images"][i], &zero = plain["images"][2];
            assert_close(image["ev"].get<double>(), same["ev"].get<double>() - zero["ev"].get<double>(), 0.01);
            assert_close(image["white_balance"][0].get<double>(),
                         same["white_balance"][0].get<double>() / zero["white_balance"][0].get<double>(), 0.01);
        }
    }
}

void test_what_is_free(void **) {
    // Exposures alone cannot explain this camera: the program reports that, together with the result.
    const Outcome poor = run_words(build_scene({"--fit", "free=ev"}));
    assert_int_equal(poor.code, not_usable);
    assert_true(contains(poor.err, "pano.pto: not usable: the pairs deviate by"));
    const Json ev = parsed(poor.out);
    assert_true(ev["usable"] == false);
    for (const Json &k : ev["vignetting"]["k"][0]) assert_close(k.get<double>(), 0, 0);
    assert_close(ev["images"][1]["white_balance"][0].get<double>(), 1, 0);
    assert_true(std::fabs(ev["images"][1]["ev"].get<double>()) > 0.1);
    const Json falloff =
        json_of(build_scene({"--fit", "free=falloff,ev,wb"}));  // not a profile, but usable to equalise the pictures
    assert_true(falloff["usable"] == false && falloff["equalizes"] == true);
    assert_close(falloff["vignetting"]["center"][0].get<double>(), 0, 0);
    assert_true(falloff["response"]["values"] == ev["response"]["values"]);
    assert_true(std::fabs(falloff["vignetting"]["k"][0][0].get<double>()) > 0.05);
    assert_true(std::fabs(falloff["images"][1]["white_balance"][0].get<double>() - 1) > 0.05);
}

// A project that was only aligned.
void test_no_photometric_lines(void **) {
    const std::string copy = copy_of("scene");
    const Words words = Words{"build", copy + "/pano.pto", "--no-store", "--fit", "stored=none", "--json"} + quick;
    const std::string all = timeless(must_exit(done, words + Words{"--fit", "free=all"}));
    edit(copy + "/pano.pto", "\nv [^\n]*", "\nv y1 p1 r1");
    const Outcome found = run_words(words);
    assert_int_equal(found.code, done);
    assert_string_equal(timeless(found.out).c_str(), all.c_str());
    assert_true(contains(found.err, "no photometric v lines"));
    assert_false(contains(run_words(words + Words{"--fit", "free=ev,falloff"}).err, "photometric"));
}

void test_one_lens(void **) {
    const std::string copy = copy_of("scene");
    edit(copy + "/pano.pto", "Ra=0 (.*img002)", "Ra0 $1");
    const Words words = Words{"build", copy + "/pano.pto", "--no-store"} + quick;
    assert_true(json_of(words + Words{"--json"})["cameras"].empty());  // according to EXIF, all are from one camera
    must_exit(done, words + Words{"--one-lens"});
}

void test_variants_of_the_fit(void **) {
    const std::string points = work("points.txt");
    must_exit(done, build_scene({"--write", std::string("points=") + points}));
    for (const Words &words :
         {Words{"--fit", "loss=huber"}, Words{"--fit", "loss=huber,huber=2"}, Words{"--fit", "loss=squared"},
          Words{"--fit", "prior=0.5"}, Words{"--fit", "method=transfer"}, Words{"--fit", "method=radiance"}})
        json_of(build_scene(words + Words{"--points", points}));
    json_of(build_scene({"--fit", "sampling=paper"}));
    json_of(build_scene({"--fit", "method=radiance,sampling=paper"}));
    json_of(build_scene({"--fit", "max-side=160"}));
    json_of(build_scene({"--fit", "max-side=0"}));
}

// Tracks instead of pairs: as accurate, the profile records the method, and the points written give the same
// tracks again except for saturated observations.
void test_method_radiance(void **) {
    const std::string points = work("tracks.txt"), db = work("tracks.db");
    const Words words = Words{"build", scene("pano.pto"), "--json",
                              "--fit", "method=radiance", "--db",
                              db,      "--write",         std::string("points=") + points,
                              "--fit", "pairs=800"};
    const Json built = json_of(words), transfer = json_of(build_scene({}));
    assert_true(built["usable"].get<bool>());
    for (size_t i = 0; i < 4; ++i)
        assert_close(built["images"][i]["white_balance"][0].get<double>(),
                     transfer["images"][i]["white_balance"][0].get<double>(), 0.03);
    const Json shown = json_of({"profile", "show", "1", "--json", "--db", db});
    assert_string_equal(shown["provenance"]["method"].get<std::string>().c_str(), "radiance");
    const Json again =
        json_of({"build", scene("pano.pto"), "--json", "--no-store", "--fit", "method=radiance", "--points", points});
    assert_close(again["residual"]["heldout_median"].get<double>(), built["residual"]["heldout_median"].get<double>(),
                 0.3);
    const Words tracks = {"--fit", "method=radiance"};
    assert_string_equal(timeless(must_exit(done, build_scene(tracks))).c_str(),
                        timeless(must_exit(done, build_scene(tracks))).c_str());
}

// The database.

void test_store_query_show_remove(void **) {
    const Words db = {"--db", work("profiles.db")};
    const Json built = json_of(Words{"build", scene("pano.pto"), "--json"} + quick + db);
    assert_int_equal(built["profile"].get<int>(), 1);
    const Json shown = json_of(Words{"profile", "show", "1", "--json"} + db);
    assert_true(shown["response"]["values"] == built["response"]["values"]);
    assert_true(shown["vignetting"] == built["vignetting"]);
    assert_string_equal(shown["key"]["camera_model"].get<std::string>().c_str(), "Simulated Camera");
    assert_close(shown["key"]["focal_mm"].get<double>(), 38.6, 1e-6);  // 18 mm / tan(25 degrees)
    assert_close(shown["key"]["aperture"].get<double>(), 2.8, 1e-6);
    assert_true(shown["key"]["distance_m"].is_null());
    assert_int_equal(shown["provenance"]["images"].get<int>(), 4);
    assert_int_equal(shown["provenance"]["pairs"].get<int>(), 600);

    must_exit(done, Words{"build", scene("pano.pto"), "--aperture", "8"} + quick + db);
    must_exit(done, Words{"build", scene("pano.pto"), "--fit", "seed=2"} + quick + db);
    const Words query = Words{"query", "--json"} + db;
    const Json open = json_of(query + Words{"--camera", "simulated camera"});  // stored at two apertures: ambiguous
    assert_true(open["id"].is_null() && open["found"].get<bool>());
    assert_int_equal(open["matches"].get<int>(), 3);
    assert_true(open["range"]["aperture"] == Json::array({2.8, 8.0}));
    const Json newest = json_of(query + Words{"--camera", "simulated camera", "--aperture", "2.8"});
    assert_int_equal(newest["id"].get<int>(), 3);
    assert_int_equal(newest["matches"].get<int>(), 2);
    assert_int_equal(json_of(query + Words{"--lens", "Simulated Lens", "--aperture", "8"})["id"].get<int>(), 2);
    assert_int_equal(json_of(query
                             + Words{"--lens", "Simulated Lens", "--aperture", "2.8", "--focal", "38.6", "--key",
                                     "maker=lensprof,processing=jpeg"})["matches"]
                         .get<int>(),
                     2);
    for (const Words &other :
         {Words{"--camera", "Simulated"}, Words{"--camera", "Simulated Camera", "--aperture", "32"},
          Words{"--camera", "Simulated Camera", "--key", "processing=corrected"}}) {
        const Json none = json_of(query + other, not_found);
        assert_true(none["id"].is_null() && !none["found"].get<bool>() && !none["reason_codes"].empty());
        const Outcome outcome = run_words(query + other);
        assert_true(contains(outcome.err, "lensprof: no profile for") && contains(outcome.err, work("profiles.db")));
        assert_true(contains(outcome.err, none["reason"].get<std::string>()));
    }
    const Json raw =
        json_of(query + Words{"--camera", "Simulated Camera", "--aperture", "2.8", "--key", "processing=raw"});
    assert_true(raw["id"].is_null() && raw["lookup"]["response"]["from"] == "raw");  // its falloff, from other pictures
    assert_true(raw["response"]["kind"] == "linear");

    const Json list = json_of(Words{"profile", "list", "--json"} + db);
    assert_int_equal(list["profiles"].size(), 3);
    assert_true(contains(must_exit(done, Words{"profile", "list"} + db), "Simulated Camera"));
    assert_int_equal(json_of(Words{"profile", "remove", "3", "--json"} + db)["removed"][0].get<int>(), 3);
    assert_int_equal(json_of(query + Words{"--lens", "Simulated Lens", "--aperture", "2.8"})["id"].get<int>(), 1);
    assert_refused(not_found, Words{"profile", "show", "3"} + db, {work("profiles.db"), "3"});
    assert_refused(not_found, Words{"profile", "remove", "3"} + db, {work("profiles.db"), "3"});
    must_exit(done, Words{"profile", "remove", "1"} + db);
    must_exit(done, Words{"profile", "remove", "2"} + db);
    assert_int_equal(json_of(Words{"profile", "list", "--json"} + db)["profiles"].size(), 0);
}

void test_key_from_the_command_line(void **) {
    const Words words = Words{"build", scene("pano.pto"), "--db", work("p.db")} + quick;
    must_exit(done, words
                        + Words{"--key", "maker=Maker", "--camera", "C\xc3\xa4mera", "--lens", "Lens", "--focal", "24",
                                "--aperture", "1.4", "--key", "distance=2.5,processing=raw,style=Velvia"});
    const Json key = json_of({"profile", "show", "1", "--json", "--db", work("p.db")})["key"];
    assert_true(
        key
        == parsed(
            R"({"camera_maker":"Maker","camera_model":"Cämera","lens":"Lens","unit":"","crop_factor":null,"focal_mm":24.0,"aperture":1.4,)"
            R"("distance_m":2.5,"color_temperature_k":null,"processing":"raw","style":"Velvia"})"));
}

void test_own_database(void **) {
    must_exit(done, Words{"build", scene("pano.pto")} + quick);
    assert_true(fs::exists(work("data/lensprof/profiles.db")));
    assert_int_equal(json_of({"query", "--camera", "Simulated Camera", "--json"})["id"].get<int>(), 1);
    must_exit(done, {"apply", "--profile", "auto", scene("img001.png"), "-o", work("out")});
    assert_true(fs::exists(work("out/img001.png")));
}

void test_forced(void **) {
    const std::string copy = copy_of("scene"), db = work("p.db");
    edit(copy + "/pano.pto", " y[-.0-9]+( .*img00[23])", " y180$1");  // overlapping each other
    const Words words = Words{"build", copy + "/pano.pto", "--db", db, "--json"} + quick;
    const Json json = json_of(words, not_usable);
    assert_false(json["usable"].get<bool>());
    assert_true(contains(text_of(json), "3 groups"));
    assert_string_equal(code_of(json).c_str(), "image_groups");
    assert_string_equal(json["findings"][0]["item"]["kind"].get<std::string>().c_str(), "image");
    const auto index = json["findings"][0]["item"]["index"].get<size_t>();
    assert_true(json["findings"][0]["item"]["file"] == json["images"][index]["file"]);
    assert_true(contains(text_of(json), json["images"][index]["file"].get<std::string>()));
    assert_true(json["findings"][0]["values"] == Json({3.0}));
    assert_true(json["profile"].is_null());
    assert_false(fs::exists(db));
    save_text(copy + "/one.pto", replaced(text_of(copy + "/pano.pto"), "\n(i [^\n]*img00[123]|v E)[^\n]*", ""));
    const Json one = json_of({"build", copy + "/one.pto", "--no-store", "--json"}, not_usable);
    assert_string_equal(code_of(one).c_str(), "few_pairs");
    assert_int_equal(json_of(words + Words{"--force"}, not_usable)["profile"].get<int>(), 1);
    assert_int_equal(json_of({"profile", "list", "--db", db, "--json"})["profiles"].size(), 1);
}

// simulate.

void test_simulate_is_repeatable(void **) {
    const Words words = {"simulate",        "--images", "3",          "--size", "64x48",           "--format",
                         "png,tiff16,jpeg", "--set",    "points=200", "--set",  "test-points=100", "--set",
                         "outliers=0.02",   "-o"};
    must_exit(done, words + Words{work("a")});
    must_exit(done, words + Words{work("b")});
    must_exit(done, Words{"simulate", "--seed", "2"} + Words(words.begin() + 1, words.end()) + Words{work("c")});
    size_t same = 0, files = 0;
    for (const fs::directory_entry &entry : fs::directory_iterator(work("a"))) {
        const std::string name = entry.path().filename().string();
        ++files;
        if (load(work("a/" + name)) != load(work("b/" + name))) fail_msg("%s differs", name.c_str());
        same += load(work("a/" + name)) == load(work("c/" + name));
    }
    assert_int_equal(files, 7);  // three pictures, project, truth, two point files
    assert_int_equal(same, 0);
}

// The pictures follow B = f(L M e w): the ratio of two pictures at a common point equals that of the truth, computed
// here with the sRGB formula.
void test_simulated_pairs_follow_the_model(void **) {
    const Json truth = parsed(text_of(scene("truth.json")));
    const auto linear = [](double b) { return b <= 0.04045 ? b / 12.92 : std::pow((b + 0.055) / 1.055, 2.4); };
    const Json &k = truth["vignetting"]["k"][0], &centre = truth["vignetting"]["center"];
    std::istringstream lines(text_of(scene("test_points.txt")));
    size_t count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        std::istringstream numbers(line);
        double column[16], radiance[2][3];
        for (double &number : column) numbers >> number;
        for (size_t side = 0; side < 2; ++side) {
            const Json &image = truth["images"][size_t(column[side])];
            const double x = (column[2 + 2 * side] - 159.5) / 200 - centre[0].get<double>();
            const double y = (column[3 + 2 * side] - 119.5) / 200 - centre[1].get<double>(), r2 = x * x + y * y;
            const double m = 1 + r2 * (k[0].get<double>() + r2 * (k[1].get<double>() + r2 * k[2].get<double>()));
            for (size_t c = 0; c < 3; ++c)
                radiance[side][c] =
                    linear(column[6 + 3 * side + c])
                    / (m * std::exp2(image["ev"].get<double>()) * image["white_balance"][c].get<double>());
        }
        for (size_t c = 0; c < 3; ++c)
            assert_close(radiance[0][c] / radiance[1][c], 1, 0.02);  // near black the response's table is a chord
    }
    assert_int_equal(count, 1500);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_help),
        CLI_TEST(test_version),
        CLI_TEST(test_unknown_command),
        CLI_TEST(test_build_keeps_its_contract),
        CLI_TEST(test_build_finds_the_truth),
        CLI_TEST(test_build_is_repeatable),
        CLI_TEST(test_build_table),
        CLI_TEST(test_points_replace_pictures),
        CLI_TEST(test_project_with_the_result),
        CLI_TEST(test_project_in_another_folder),
        CLI_TEST(test_reference),
        CLI_TEST(test_what_is_free),
        CLI_TEST(test_no_photometric_lines),
        CLI_TEST(test_one_lens),
        CLI_TEST(test_variants_of_the_fit),
        CLI_TEST(test_method_radiance),
        CLI_TEST(test_store_query_show_remove),
        CLI_TEST(test_key_from_the_command_line),
        CLI_TEST(test_own_database),
        CLI_TEST(test_forced),
        CLI_TEST(test_simulate_is_repeatable),
        CLI_TEST(test_simulated_pairs_follow_the_model),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
